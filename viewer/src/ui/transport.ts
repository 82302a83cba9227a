// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { button, element, setHidden, setText } from "../dom";
import { clock } from "../format";
import { PlaybackClock } from "../stream/playback_clock";
import { type ServerInfo, secondsOf } from "../stream/protocol";
import type { Stream } from "../stream/stream";
import "./transport.css";

const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 4, 8];
const PERIOD_MS = 50;
const STEP_S = 1;

/** Play, pause, speed and place of a recording that is served. */
export class Transport {
  readonly element: HTMLElement;
  readonly #stream: Stream;
  readonly #play = button("Play", () => this.toggle(), { "data-role": "play" });
  readonly #now = element("span", { class: "figure", "data-role": "playback-now" });
  readonly #length = element("span", { class: "figure dim" });
  readonly #bar: HTMLInputElement;
  readonly #speed: HTMLSelectElement;
  #clock: PlaybackClock | undefined;
  #isScrubbing = false;
  #drawnMs = 0;

  constructor(stream: Stream) {
    this.#stream = stream;
    this.#bar = element("input", {
      type: "range",
      min: 0,
      max: 1000,
      step: 0.01,
      class: "scrub",
      "aria-label": "Place in the recording",
      "data-role": "scrub",
      oninput: () => this.#scrub(),
      onchange: () => (this.#isScrubbing = false),
    });
    this.#speed = element(
      "select",
      {
        class: "field compact",
        "aria-label": "Speed",
        "data-role": "speed",
        onchange: () => this.#send(this.#clock?.isPlaying ?? true),
      },
      ...SPEEDS.map((speed) => element("option", { value: speed, selected: speed === 1 }, `${speed} \u00d7`)),
    );
    this.element = element(
      "footer",
      { class: "transport", "aria-label": "Playback", "data-role": "transport", hidden: true },
      this.#play,
      this.#now,
      this.#bar,
      this.#length,
      this.#speed,
    );
    stream.serverInfo.follow((info) => this.#begin(info));
    stream.playback.follow((state) => {
      if (state !== undefined) this.#clock?.tell(state, performance.now());
      // Before it is known, a seek would say whether to play, too.
      setHidden(this.element, this.#clock === undefined || state === undefined);
    });
  }

  get isThere(): boolean {
    return this.#clock !== undefined;
  }

  toggle(): void {
    if (this.#clock === undefined) return;
    if (this.#clock.hasEnded) this.#send(true, 0);
    else this.#send(!this.#clock.isPlaying);
  }

  /** Forward, or back where negative. */
  step(seconds = STEP_S): void {
    if (this.#clock === undefined) return;
    this.#send(
      this.#clock.isPlaying,
      Math.min(this.#clock.lengthS, Math.max(0, this.#clock.positionS(performance.now()) + seconds)),
    );
  }

  draw(nowMs: number): void {
    const playback = this.#clock;
    if (playback === undefined || nowMs - this.#drawnMs < PERIOD_MS) return;
    this.#drawnMs = nowMs;
    setText(this.#play, playback.hasEnded ? "Again" : playback.isPlaying ? "Pause" : "Play");
    if (this.#isScrubbing) return;
    const position = playback.positionS(nowMs);
    setText(this.#now, clock(position));
    const value = ((1000 * position) / Math.max(1e-9, playback.lengthS)).toFixed(2);
    if (this.#bar.value !== value) this.#bar.value = value;
    this.#bar.setAttribute("aria-valuetext", clock(position));
  }

  #begin(info: ServerInfo | undefined): void {
    const { dataStartTime: start, dataEndTime: end } = info ?? {};
    const canPlay = info?.capabilities.includes("playbackControl") === true && start !== undefined && end !== undefined;
    this.#clock = canPlay ? new PlaybackClock(secondsOf(start), secondsOf(end)) : undefined;
    setHidden(this.element, true);
    if (this.#clock !== undefined) setText(this.#length, clock(this.#clock.lengthS));
  }

  #scrub(): void {
    if (this.#clock === undefined) return;
    this.#isScrubbing = true;
    const position = (this.#clock.lengthS * Number(this.#bar.value)) / 1000;
    setText(this.#now, clock(position));
    this.#send(this.#clock.isPlaying, position);
  }

  #send(play: boolean, positionS?: number): void {
    const [playback, speed, nowMs] = [this.#clock!, Number(this.#speed.value), performance.now()];
    const seek = positionS === undefined ? undefined : playback.startS + positionS;
    if (this.#stream.control(play, speed, seek))
      playback.ask(play, speed, positionS ?? playback.positionS(nowMs), nowMs);
  }
}
