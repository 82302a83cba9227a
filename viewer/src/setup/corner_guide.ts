// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { button, element, setText } from "../dom";
import { AS_SENT, cornerOf, describeWayRound, type Place, type WayRound, wayRound } from "./corners";
import type { Shape, Touch, TouchFeed } from "./touch_feed";

/** A finger that lands touches other taxels for a moment. */
const STEADY_ANSWERS = 3;

/** Asks for two touches, and finds from them which way round the lines are sent. */
export class CornerGuide {
  readonly element: HTMLElement;
  readonly #feed: TouchFeed;
  readonly #shape: () => Shape | undefined;
  readonly #turned: (way: WayRound) => void;
  readonly #words = element("p", { role: "status", "data-role": "corner-words" });
  #isAsking = false;
  #way = AS_SENT;
  #first: Place | undefined;
  #steady: { corner: Place | undefined; answers: number } = { corner: undefined, answers: 0 };

  /** `shape`: of the sent frames, where it is known; `turned`: called with the result. */
  constructor(feed: TouchFeed, shape: () => Shape | undefined, turned: (way: WayRound) => void) {
    this.#feed = feed;
    this.#shape = shape;
    this.#turned = turned;
    this.element = element(
      "div",
      { class: "corner-guide" },
      button("Touch two corners", () => this.#begin(), { "data-role": "corners" }),
      this.#words,
    );
    feed.latest.follow((touch) => this.#isAsking && touch !== undefined && this.#take(touch));
    this.forget();
  }

  get way(): WayRound {
    return this.#way;
  }

  /** Nothing is known: the lines are taken as they are sent. */
  forget(): void {
    this.#isAsking = false;
    this.#way = AS_SENT;
    this.#first = undefined;
    this.#steady = { corner: undefined, answers: 0 };
    setText(this.#words, "If rows and columns may be exchanged, or run backwards: two touches tell.");
  }

  #begin(): void {
    this.forget();
    this.#turned(AS_SENT);
    const shape = this.#shape();
    if (shape === undefined) {
      setText(this.#words, "Fill in rows and columns first, 2 or more of each.");
      return;
    }
    setText(this.#words, "Take your hands off the array.");
    this.#isAsking = true;
    void this.#feed.watch(shape);
  }

  #take(touch: Touch): void {
    const shape = this.#feed.shape;
    if (shape === undefined) return;
    if (touch.problem !== "") {
      this.forget();
      setText(this.#words, touch.problem);
    } else if (touch.ready && this.#sees(touch.touched, shape.rows, shape.cols)) {
      this.#isAsking = false;
    }
  }

  /** Whether all is known. */
  #sees(touched: Place | null, rows: number, cols: number): boolean {
    const corner = touched === null ? undefined : cornerOf(touched, rows, cols);
    if (this.#first === undefined)
      setText(
        this.#words,
        touched !== null && corner === undefined
          ? "This is no corner. Press the corner next to the connector."
          : "Press the corner next to the connector.",
      );
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
    setText(this.#words, describeWayRound(way));
    this.#turned(way);
    return true;
  }

  #isSteady(corner: Place | undefined): boolean {
    const isSame = corner?.[0] === this.#steady.corner?.[0] && corner?.[1] === this.#steady.corner?.[1];
    this.#steady = { corner, answers: isSame ? this.#steady.answers + 1 : 1 };
    return this.#steady.answers >= STEADY_ANSWERS;
  }
}
