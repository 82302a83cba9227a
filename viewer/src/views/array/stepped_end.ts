// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { endThatHolds } from "./quantities";

/** A lower end waits until nothing came near the present one for so long. */
const QUIET_S = 5;

/** The end of a scale that follows its values in steps: up as soon as one is beyond it, down after a quiet time. */
export class SteppedEnd {
  /** 0: nothing seen yet. */
  value = 0;
  #highest = 0;
  #sinceS = NaN;

  restart(): void {
    this.value = 0;
    this.#highest = 0;
    this.#sinceS = NaN;
  }

  /** True: the end is another one now. */
  see(highest: number, stampS: number, ends: readonly number[]): boolean {
    const before = this.value;
    const elapsedS = stampS - this.#sinceS;
    this.#highest = Math.max(this.#highest, highest);
    const holds = endThatHolds(this.#highest, ends);
    if (!(elapsedS >= 0 && elapsedS < QUIET_S)) {
      this.value = holds;
      this.#highest = highest;
      this.#sinceS = stampS;
    } else if (holds > this.value) {
      this.value = holds;
    }
    return this.value !== before;
  }
}
