// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { type PlaybackState, PlaybackStatus } from "./protocol";

/** Where a recording is now, between the states that the server sends. */
export class PlaybackClock {
  readonly startS: number;
  readonly endS: number;
  #state: PlaybackState;
  #toldMs = 0;

  constructor(startS: number, endS: number) {
    this.startS = startS;
    this.endS = Math.max(startS, endS);
    this.#state = { status: PlaybackStatus.paused, nowS: startS, speed: 1, didSeek: false };
  }

  tell(state: PlaybackState, nowMs: number): void {
    this.#state = state;
    this.#toldMs = nowMs;
  }

  /** Holds until the server sends a state: a user who pauses and seeks before that has asked for both. */
  ask(play: boolean, speed: number, positionS: number, nowMs: number): void {
    this.tell(
      {
        status: play ? PlaybackStatus.playing : PlaybackStatus.paused,
        nowS: this.startS + positionS,
        speed,
        didSeek: false,
      },
      nowMs,
    );
  }

  get isPlaying(): boolean {
    return this.#state.status === PlaybackStatus.playing;
  }

  get hasEnded(): boolean {
    return this.#state.status === PlaybackStatus.ended;
  }

  get speed(): number {
    return this.#state.speed;
  }

  get lengthS(): number {
    return this.endS - this.startS;
  }

  /** Seconds since the beginning of the recording. */
  positionS(nowMs: number): number {
    const since = this.isPlaying ? (this.#state.speed * (nowMs - this.#toldMs)) / 1000 : 0;
    return Math.min(this.lengthS, Math.max(0, this.#state.nowS + since - this.startS));
  }
}
