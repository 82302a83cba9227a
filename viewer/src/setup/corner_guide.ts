// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { element, setHidden, setText } from "../dom";
import type { Stream } from "../stream/stream";
import { AS_SENT, cornerOf, describeWayRound, wayRound, type Place, type WayRound } from "./corners";

const PERIOD_MS = 120;
/** A finger that lands touches other taxels for a moment. */
const STEADY_ANSWERS = 3;

/** What /array/touch answers. */
interface Touch {
  ready: boolean;
  touched: Place | null;
  problem: string;
}

/** Asks for two touches, and tells from them which way round the lines are sent. */
export class CornerGuide {
  readonly element: HTMLElement;
  readonly #stream: Stream;
  readonly #shape: () => { rows: number; cols: number } | undefined;
  readonly #turned: (way: WayRound) => void;
  readonly #words = element("p", { role: "status", "data-role": "corner-words" });
  readonly #dot = element("span", { class: "touch-dot", hidden: true });
  readonly #picture = element("div", { class: "touch-picture", "data-role": "touch-picture", hidden: true }, this.#dot);
  #way = AS_SENT;
  #first: Place | undefined;
  #steady: { corner: Place | undefined; answers: number } = { corner: undefined, answers: 0 };
  #round = 0;

  /** `shape`: of what is sent, where it is known; `turned`: told what was found. */
  constructor(stream: Stream, shape: () => { rows: number; cols: number } | undefined, turned: (way: WayRound) => void) {
    this.#stream = stream;
    this.#shape = shape;
    this.#turned = turned;
    this.element = element(
      "div",
      { class: "corner-guide" },
      element("button", { class: "button", type: "button", "data-role": "corners", onclick: () => void this.#begin() }, "Touch two corners"),
      this.#words,
      this.#picture,
    );
    this.forget();
  }

  get way(): WayRound {
    return this.#way;
  }

  /** Nothing is known: the lines are taken as they are sent. */
  forget(): void {
    this.#round += 1;
    this.#way = AS_SENT;
    this.#first = undefined;
    this.#steady = { corner: undefined, answers: 0 };
    setHidden(this.#picture, true);
    setText(this.#words, "If rows and columns may be exchanged, or run backwards: two touches tell.");
  }

  async #begin(): Promise<void> {
    this.forget();
    this.#turned(AS_SENT);
    const shape = this.#shape();
    if (shape === undefined) return setText(this.#words, "Fill in rows and columns first, 2 or more of each.");
    this.#picture.style.aspectRatio = `${shape.cols} / ${shape.rows}`;
    try {
      await this.#follow(shape.rows, shape.cols);
    } catch (error) {
      setText(this.#words, error instanceof Error ? error.message : String(error));
    }
  }

  /** Until all is known, or it is begun anew. */
  async #follow(rows: number, cols: number): Promise<void> {
    const round = this.#round;
    await this.#stream.callService("/array/watch", { rows, cols });
    setText(this.#words, "Take your hands off the array.");
    for (;;) {
      await new Promise((resolve) => window.setTimeout(resolve, PERIOD_MS));
      if (round !== this.#round) return;
      const touch = (await this.#stream.callService("/array/touch", {})) as Touch;
      if (round !== this.#round) return;
      if (touch.problem !== "") throw new Error(touch.problem);
      if (touch.ready && this.#sees(touch.touched, rows, cols)) return;
    }
  }

  /** Whether all is known. */
  #sees(touched: Place | null, rows: number, cols: number): boolean {
    this.#show(touched, rows, cols);
    const corner = touched === null ? undefined : cornerOf(touched, rows, cols);
    if (this.#first === undefined) setText(this.#words, touched !== null && corner === undefined ? "This is no corner. Press the corner next to the connector." : "Press the corner next to the connector.");
    if (!this.#isSteady(corner) || corner === undefined) return false;
    if (this.#first === undefined) {
      this.#first = corner;
      setText(this.#words, "Now the other end of the row that begins there: of the first line that is driven.");
      return false;
    }
    if (corner[0] === this.#first[0] && corner[1] === this.#first[1]) return false;
    const way = wayRound(this.#first, corner);
    if (way === undefined) {
      setText(this.#words, "This is the opposite corner. Press the other end of the first row.");
      return false;
    }
    this.#way = way;
    setHidden(this.#picture, true);
    setText(this.#words, describeWayRound(way));
    this.#turned(way);
    return true;
  }

  #isSteady(corner: Place | undefined): boolean {
    const isSame = corner?.[0] === this.#steady.corner?.[0] && corner?.[1] === this.#steady.corner?.[1];
    this.#steady = { corner, answers: isSame ? this.#steady.answers + 1 : 1 };
    return this.#steady.answers >= STEADY_ANSWERS;
  }

  #show(touched: Place | null, rows: number, cols: number): void {
    setHidden(this.#picture, false);
    setHidden(this.#dot, touched === null);
    if (touched === null) return;
    this.#dot.style.top = `${(100 * (touched[0] + 0.5)) / rows}%`;
    this.#dot.style.left = `${(100 * (touched[1] + 0.5)) / cols}%`;
  }
}
