// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

/** A rest that was wrong, because something lay there at first, is forgotten after about so many pictures. */
const FORGOTTEN_AFTER = 300;
/** So many times the noise is nothing. */
const NOISE_FLOOR = 8;
const LEAST_FLOOR = 16;
const LEAST_RANGE = 200;

/** How far the counts of an array of which nothing is known are from where they rest, as shares of what was seen. */
export class Rest {
  #rest: number[] = [];
  #before: (number | null)[] = [];
  #noise = 0;
  #widest = 0;

  /** 0 to 1 for each count; null where there is none. */
  sharesOf(counts: readonly (number | null)[]): (number | null)[] {
    if (this.#rest.length !== counts.length) this.#begin(counts);
    this.#hearNoise(counts);
    const floor = Math.max(LEAST_FLOOR, NOISE_FLOOR * this.#noise);
    const away = counts.map((count, taxel) => (count === null ? null : Math.abs(count - this.#rest[taxel]!)));
    for (const one of away) if (one !== null) this.#widest = Math.max(this.#widest, one);
    counts.forEach((count, taxel) => {
      if (count !== null) this.#rest[taxel]! += (count - this.#rest[taxel]!) / FORGOTTEN_AFTER;
    });
    const range = Math.max(LEAST_RANGE, this.#widest, 2 * floor);
    return away.map((one) => (one === null ? null : one < floor ? 0 : one / range));
  }

  #begin(counts: readonly (number | null)[]): void {
    this.#rest = counts.map((count) => count ?? 0);
    this.#before = [];
    this.#noise = this.#widest = 0;
  }

  /** The middle one of the steps of all taxels since the picture before: presses are few. */
  #hearNoise(counts: readonly (number | null)[]): void {
    const steps = this.#before
      .map((before, taxel) => Math.abs((counts[taxel] ?? 0) - (before ?? 0)))
      .sort((one, other) => one - other);
    this.#noise += 0.1 * ((steps[Math.floor(steps.length / 2)] ?? this.#noise) - this.#noise);
    this.#before = [...counts];
  }
}
