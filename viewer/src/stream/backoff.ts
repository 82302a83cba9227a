// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

const FIRST_MS = 250;
const LONGEST_MS = 5000;
const GROWTH = 1.7;

/** How long to wait before the next attempt: growing, and scattered so that many pages do not come at once. */
export class Backoff {
  readonly #random: () => number;
  #attempts = 0;

  constructor(random: () => number = Math.random) {
    this.#random = random;
  }

  get attempts(): number {
    return this.#attempts;
  }

  nextMs(): number {
    const wait = Math.min(LONGEST_MS, FIRST_MS * GROWTH ** this.#attempts);
    this.#attempts += 1;
    return Math.round(wait * (0.8 + 0.4 * this.#random()));
  }

  reset(): void {
    this.#attempts = 0;
  }
}
