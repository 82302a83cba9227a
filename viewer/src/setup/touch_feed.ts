// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { errorText } from "../format";
import { Signal } from "../signal";
import type { Stream } from "../stream/stream";
import type { Place } from "./corners";

const PERIOD_MS = 120;

export interface Shape {
  rows: number;
  cols: number;
}

/** The answer of /array/touch. */
export interface Touch {
  ready: boolean;
  touched: Place | null;
  problem: string;
  /** Readings of the newest frame, row-major, as they are sent; empty before the first. */
  counts: (number | null)[];
}

/** The traffic of the source, while a question is open. */
export class TouchFeed {
  /** undefined: nothing has come yet, or nothing is watched. */
  readonly latest = new Signal<Touch | undefined>(undefined);
  shape: Shape | undefined;
  readonly #stream: Stream;
  #round = 0;

  constructor(stream: Stream) {
    this.#stream = stream;
  }

  /** Begins anew: nothing may press the array until its rest is known. */
  async watch(shape: Shape): Promise<void> {
    this.stop();
    const round = this.#round;
    this.shape = shape;
    try {
      await this.#stream.callService("/array/watch", shape);
      while (round === this.#round) {
        const touch = (await this.#stream.callService("/array/touch", {})) as Touch;
        if (round !== this.#round) return;
        this.latest.value = touch;
        if (touch.problem !== "") return;
        await new Promise((resolve) => window.setTimeout(resolve, PERIOD_MS));
      }
    } catch (error) {
      const problem = errorText(error);
      if (round === this.#round) this.latest.value = { ready: false, touched: null, problem, counts: [] };
    }
  }

  stop(): void {
    this.#round += 1;
    this.shape = undefined;
    this.latest.value = undefined;
  }
}
