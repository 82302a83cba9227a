// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { describe, expect, it } from "vitest";
import { PlaybackClock } from "./playback_clock";
import { PlaybackStatus, playbackControl, readPlaybackState } from "./protocol";

const playing = { status: PlaybackStatus.playing, nowS: 102, speed: 2, didSeek: false };

describe("the playback clock", () => {
  it("goes on between the states that it is told, at their speed", () => {
    const clock = new PlaybackClock(100, 160);
    expect(clock.positionS(0)).toBe(0);
    clock.tell(playing, 1000);
    expect(clock.positionS(1000)).toBe(2);
    expect(clock.positionS(2500)).toBe(5);
    expect(clock.isPlaying).toBe(true);
  });

  it("is where it was asked to be, until it is told", () => {
    const clock = new PlaybackClock(100, 160);
    clock.tell(playing, 1000);
    clock.ask(false, 2, clock.positionS(2000), 2000);
    expect(clock.isPlaying).toBe(false);
    expect(clock.positionS(9000)).toBe(4);
    clock.ask(true, 4, 30, 9000);
    expect(clock.positionS(10000)).toBe(34);
    clock.tell(playing, 10000);
    expect(clock.positionS(10000)).toBe(2);
  });

  it("stands where it is paused, and ends with the recording", () => {
    const clock = new PlaybackClock(100, 160);
    clock.tell({ ...playing, status: PlaybackStatus.paused }, 1000);
    expect(clock.positionS(90000)).toBe(2);
    clock.tell(playing, 1000);
    expect(clock.positionS(900000)).toBe(60);
    clock.tell({ ...playing, status: PlaybackStatus.ended, nowS: 160 }, 1000);
    expect(clock.hasEnded).toBe(true);
    expect(clock.positionS(0)).toBe(60);
  });
});

describe("the messages of the playback", () => {
  it("have the bytes of the protocol", () => {
    const view = new DataView(playbackControl(false, 0.5, 1700000000.25).buffer);
    expect(view.byteLength).toBe(19);
    expect(view.getUint8(0)).toBe(3);
    expect(view.getUint8(1)).toBe(1);
    expect(view.getFloat32(2, true)).toBe(0.5);
    expect(view.getUint8(6)).toBe(1);
    expect(view.getBigUint64(7, true)).toBe(1700000000250000000n);
    expect(view.getUint32(15, true)).toBe(0);
  });

  it("are read at the bytes of the protocol", () => {
    const view = new DataView(new ArrayBuffer(19));
    view.setUint8(0, 5);
    view.setUint8(1, 3);
    view.setBigUint64(2, 1700000000250000000n, true);
    view.setFloat32(10, 4, true);
    view.setUint8(14, 1);
    expect(readPlaybackState(view)).toEqual({ status: 3, nowS: 1700000000.25, speed: 4, didSeek: true });
  });
});
