// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { fixed } from "../format";
import { PlaybackStatus } from "../stream/protocol";
import type { Connection } from "../stream/stream";

/** The state of the connection and of its traffic. */
export interface LinkState {
  connection: Connection;
  nowMs: number;
  /** The server asks where the array is or how it is made. */
  isAsked: boolean;
  /** The traffic makes no frames. */
  isUnreadable: boolean;
  /** The picture of this page stands. */
  isPaused: boolean;
  /** State of a recording; undefined: the source is live. */
  playback: number | undefined;
  /** Since the last frame came; NaN: none has come. */
  silenceS: number;
  /** Delay of live frames; a recording has a clock of its own. */
  lateS: number;
}

export type Level = "good" | "warn" | "bad";

const QUIET_S = 2;
const LATE_S = 1;

export function connectionWords(state: LinkState): [Level, string] {
  const { connection, nowMs } = state;
  switch (connection.kind) {
    case "connecting":
      return ["warn", "Connecting"];
    case "live":
      return liveWords(state);
    case "retrying":
      return [
        "bad",
        `${connection.wasLive ? "Lost" : "No server"}, again in ${Math.max(0, Math.ceil((connection.atMs - nowMs) / 1000))} s`,
      ];
    case "wrong token":
      return ["bad", "Wrong token"];
  }
}

function liveWords({ isAsked, isUnreadable, isPaused, playback, silenceS, lateS }: LinkState): [Level, string] {
  if (isUnreadable) return ["bad", "Not readable"];
  if (isAsked) return ["warn", "Waiting for your answer"];
  if (isPaused || playback === PlaybackStatus.paused) return ["good", "Paused"];
  if (playback === PlaybackStatus.ended) return ["good", "At its end"];
  if (Number.isNaN(silenceS)) return ["warn", "Waiting for frames"];
  if (silenceS > QUIET_S) return ["warn", `No frames for ${fixed(Math.floor(silenceS), 0)} s`];
  if (playback === undefined && lateS > LATE_S) return ["warn", `${fixed(lateS, 0)} s late`];
  return ["good", playback === PlaybackStatus.playing ? "Playing" : "Live"];
}
