// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { emptyGrid, type GridFrame, readGrid, TaxelStatus } from "../messages/grids";
import { Signal } from "../signal";
import type { ArrayDescription } from "../suit";
import { ForceHistory } from "./force_history";

/** A rectangle of taxels of an array: first and last of its rows and columns. */
export interface Region {
  readonly array: string;
  readonly rows: readonly [number, number];
  readonly cols: readonly [number, number];
}

/** The rectangle between two taxels. */
export function regionBetween(array: ArrayDescription, one: number, other: number): Region {
  const ends = (a: number, b: number): [number, number] => [Math.min(a, b), Math.max(a, b)];
  const row = (taxel: number): number => Math.floor(taxel / array.cols);
  return { array: array.name, rows: ends(row(one), row(other)), cols: ends(one % array.cols, other % array.cols) };
}

export function regionName({ rows, cols }: Region): string {
  return `r${rows[0]}c${cols[0]} \u2013 r${rows[1]}c${cols[1]}`;
}

/** Least force of a counted taxel in standard deviations: forces are cut at zero, so noise of others would add up. */
export const COUNTED_SIGMAS = 3;

/** The force on the region that the user has drawn, from then on, whatever is shown. Faulty taxels have none. */
export class RegionForce {
  readonly region = new Signal<Region | undefined>(undefined);
  history = new ForceHistory();
  newtons = NaN;
  readonly #frame = emptyGrid();
  #end = (): void => undefined;

  /** `subscribe`: to a topic that stands still in a pause; returns what ends it. */
  constructor(subscribe: (topic: string, handler: (message: DataView) => void) => () => void) {
    this.region.follow((region) => {
      this.#end();
      this.history = new ForceHistory();
      this.newtons = NaN;
      this.#end =
        region === undefined
          ? () => undefined
          : subscribe(`/${region.array}/force`, (message) => this.#receive(message, region));
    });
  }

  #receive(message: DataView, region: Region): void {
    if (region !== this.region.value) return; // held since before it was drawn anew
    const { rows, cols } = region;
    const frame = this.#frame;
    readGrid(message, frame);
    let sum = 0;
    for (let row = rows[0]; row <= rows[1]; ++row) {
      for (let taxel = row * frame.cols + cols[0]; taxel <= row * frame.cols + cols[1]; ++taxel) {
        if (counts(frame, taxel)) sum += frame.values[taxel]!;
      }
    }
    this.newtons = sum;
    this.history.add(frame.stampS, sum);
  }
}

/** Saturated taxels have a standard deviation without bound, and count. */
function counts({ values, sigmas, statuses }: GridFrame, taxel: number): boolean {
  const isLoaded = values[taxel]! > COUNTED_SIGMAS * sigmas[taxel]! || sigmas[taxel] === Infinity;
  return isLoaded && statuses[taxel]! < TaxelStatus.dead;
}
