// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import type { CountsFrame } from "../../messages/grids";

export const TIME_SHARES = ["now", "highest", "average"] as const;
/** The span of time that a map shows: the newest frame, the highest value of each taxel since a reset, its average. */
export type TimeShare = (typeof TIME_SHARES)[number];

/** The average forgets what is older than about this. */
const AVERAGE_S = 1;

/** The highest value, or the running average, of each taxel over the frames that came. */
export class HeldValues {
  values = new Float32Array(0);
  #lastS = NaN;

  reset(): void {
    this.values = new Float32Array(0);
  }

  add({ values, stampS }: CountsFrame, share: "highest" | "average"): void {
    const isFirst = this.values.length !== values.length;
    if (isFirst) this.values = values.slice();
    else if (share === "highest") this.#raise(values);
    else this.#follow(values, stampS - this.#lastS);
    this.#lastS = stampS;
  }

  /** A value that is not a number gives way to any other. */
  #raise(values: Float32Array): void {
    for (let taxel = 0; taxel < values.length; ++taxel) {
      const value = values[taxel]!;
      if (value > this.values[taxel]! || Number.isNaN(this.values[taxel]!)) this.values[taxel] = value;
    }
  }

  #follow(values: Float32Array, stepS: number): void {
    const weight = stepS >= 0 ? 1 - Math.exp(-stepS / AVERAGE_S) : 1;
    for (let taxel = 0; taxel < values.length; ++taxel) {
      const held = this.values[taxel]!;
      this.values[taxel] = Number.isNaN(held) ? values[taxel]! : held + weight * (values[taxel]! - held);
    }
  }
}
