// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

/** Log times go on with the clock of the server, which may differ from ours: the quickest message shows by how much. */
export class Delay {
  #logS = NaN;
  #least = Infinity;
  #arrivedMs = NaN;

  /** A message that was made at `logS` has arrived; both clocks go on alike. */
  add(logS: number, nowMs: number): void {
    if (logS < this.#logS) this.#least = Infinity; // a recording or a simulation that begins anew
    this.#logS = logS;
    this.#arrivedMs = nowMs;
    this.#least = Math.min(this.#least, nowMs / 1000 - logS);
  }

  /** Nothing is known of the next connection. */
  restart(): void {
    this.#logS = NaN;
    this.#least = Infinity;
    this.#arrivedMs = NaN;
  }

  /** Since the last message came; NaN before the first. */
  silenceS(nowMs: number): number {
    return (nowMs - this.#arrivedMs) / 1000;
  }

  /** How much longer the last message took than the quickest one. */
  get lateS(): number {
    return this.#arrivedMs / 1000 - this.#logS - this.#least;
  }
}
