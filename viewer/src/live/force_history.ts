// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

/** The history is kept in steps of this long. */
export const BIN_S = 0.02;
/** A minute, and a little. */
export const BINS = 3072;

const HELD_BINS = 25;
const BACKWARD_BINS = 50;

export function binOf(stampS: number): number {
  return Math.floor(stampS / BIN_S);
}

/** One force over the last minute: a ring of steps, NaN where there was none. */
export class ForceHistory {
  readonly #values = new Float32Array(BINS).fill(NaN);
  #lastBin = -1;

  /** A time before the last one by a second or more begins anew: a recording was rewound. */
  add(stampS: number, newtons: number): void {
    const bin = binOf(stampS);
    if (this.#lastBin < 0 || bin < this.#lastBin - BACKWARD_BINS || bin - this.#lastBin > BINS) {
      this.#values.fill(NaN);
    } else if (bin < this.#lastBin) {
      return;
    } else {
      const between = bin - this.#lastBin <= HELD_BINS ? this.#values[this.#lastBin % BINS]! : NaN;
      for (let gap = this.#lastBin + 1; gap < bin; ++gap) this.#values[gap % BINS] = between;
    }
    this.#values[bin % BINS] = newtons;
    this.#lastBin = bin;
  }

  at(bin: number): number {
    if (bin <= this.#lastBin) return bin > this.#lastBin - BINS ? this.#values[bin % BINS]! : NaN;
    return bin - this.#lastBin <= HELD_BINS ? this.#values[this.#lastBin % BINS]! : NaN;
  }

  /** The points of a plot that ends with `endBin`: the highest of `binsPerPoint` steps each. */
  copy(endBin: number, binsPerPoint: number, points: Float64Array): void {
    for (let point = points.length - 1, bin = endBin; point >= 0; --point) {
      let highest = NaN;
      for (let step = 0; step < binsPerPoint; ++step, --bin) {
        const value = this.at(bin);
        if (value > highest || Number.isNaN(highest)) highest = value;
      }
      points[point] = highest;
    }
  }
}
