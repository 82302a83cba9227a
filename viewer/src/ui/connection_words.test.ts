// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { expect, it } from "vitest";
import { PlaybackStatus } from "../stream/protocol";
import { connectionWords, type LinkState } from "./connection_words";

const LIVE: LinkState = {
  connection: { kind: "live" },
  nowMs: 0,
  isAsked: false,
  isUnreadable: false,
  isPaused: false,
  playback: undefined,
  silenceS: 0.1,
  lateS: 0,
};

it.each<[Partial<LinkState>, string, string]>([
  [{}, "good", "Live"],
  [{ isPaused: true, silenceS: 9 }, "good", "Paused"],
  [{ playback: PlaybackStatus.playing, lateS: 4.1 }, "good", "Playing"],
  [{ playback: PlaybackStatus.paused, silenceS: 9 }, "good", "Paused"],
  [{ playback: PlaybackStatus.ended, silenceS: 9 }, "good", "At its end"],
  [{ lateS: 4.1 }, "warn", "4 s late"],
  [{ silenceS: 3.2, lateS: 4 }, "warn", "No frames for 3 s"],
  [{ silenceS: NaN, lateS: NaN }, "warn", "Waiting for frames"],
  [{ isAsked: true }, "warn", "Waiting for your answer"],
  [{ isAsked: true, isUnreadable: true }, "bad", "Not readable"],
  [{ isUnreadable: true, silenceS: 9 }, "bad", "Not readable"],
  [{ connection: { kind: "connecting" } }, "warn", "Connecting"],
  [{ connection: { kind: "wrong token" } }, "bad", "Wrong token"],
  [{ connection: { kind: "retrying", wasLive: true, atMs: 1500 } }, "bad", "Lost, again in 2 s"],
  [{ connection: { kind: "retrying", wasLive: false, atMs: 1500 } }, "bad", "No server, again in 2 s"],
])("%o is %s: %s", (state, level, words) => {
  expect(connectionWords({ ...LIVE, ...state })).toEqual([level, words]);
});
