// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { button, element, setHidden, setText } from "../dom";
import { clock, errorText } from "../format";
import type { Marks } from "../live/marks";
import { PlaybackClock } from "../stream/playback_clock";
import { type ServerInfo, secondsOf } from "../stream/protocol";
import type { Stream } from "../stream/stream";
import { MarkList } from "./mark_list";
import "./transport.css";

const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 4, 8];
const PERIOD_MS = 50;
const STEP_S = 1;

/** Play, pause, speed and place of a recording that is served. */
export class Transport {
  readonly element: HTMLElement;
  readonly marks: MarkList;
  readonly #stream: Stream;
  readonly #marks: Marks;
  readonly #mark: HTMLElement;
  readonly #problem = element("span", { class: "attention", role: "alert" });
  readonly #play = button("Play", () => this.toggle(), { "data-role": "play" });
  readonly #now = element("span", { class: "figure", "data-role": "playback-now" });
  readonly #length = element("span", { class: "figure dim" });
  readonly #bar: HTMLInputElement;
  readonly #speed: HTMLSelectElement;
  #clock: PlaybackClock | undefined;
  #isScrubbing = false;
  #drawnMs = 0;

  constructor(stream: Stream, marks: Marks) {
    this.#stream = stream;
    this.#marks = marks;
    const fail = (error: unknown): void => setText(this.#problem, errorText(error));
    this.marks = new MarkList(marks, (positionS) => this.#send(this.#clock?.isPlaying ?? false, positionS), fail);
    this.#mark = button("Mark", () => this.mark(), { title: "A mark at this moment (M)", "data-role": "mark-here" });
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
      element("div", { class: "time-line" }, this.#bar, this.marks.ticks),
      this.#length,
      this.#speed,
      this.#mark,
      this.#problem,
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

  /** At the place in the recording. */
  mark(): void {
    if (this.#clock === undefined) return;
    const atS = this.#clock.startS + this.#clock.positionS(performance.now());
    setText(this.#problem, "");
    this.#marks.add(atS).catch((error) => {
      setText(this.#problem, errorText(error));
    });
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
    this.marks.begin(this.#clock?.startS ?? 0, this.#clock?.lengthS ?? 0);
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
