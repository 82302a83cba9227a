// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { ForceHistory } from "../../live/force_history";
import { emptyGrid, readCounts } from "../../messages/grids";
import type { Stream } from "../../stream/stream";

/** The highest reading of arrays that have no forces yet, as long as somebody looks. */
export class ReadingHistories {
  readonly #stream: Stream;
  readonly #histories = new Map<string, ForceHistory>();
  readonly #frame = emptyGrid();
  #ends: (() => void)[] = [];

  constructor(stream: Stream) {
    this.#stream = stream;
  }

  of(array: string): ForceHistory {
    const history = this.#histories.get(array) ?? new ForceHistory();
    this.#histories.set(array, history);
    return history;
  }

  follow(arrays: readonly string[]): void {
    this.#ends.splice(0).forEach((end) => end());
    this.#ends = arrays.map((array) =>
      this.#stream.subscribe(`/${array}/raw`, (message) => this.#add(this.of(array), message)),
    );
  }

  #add(history: ForceHistory, message: DataView): void {
    readCounts(message, this.#frame);
    history.add(
      this.#frame.stampS,
      this.#frame.values.reduce((highest, count) => Math.max(highest, count), 0),
    );
  }
}
