// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

const KEPT = 240;

/** How quickly frames reach the screen: from their time to the frame of the screen after the one they were drawn in. */
export class DisplayStatistics {
  /** Frames of the array view. */
  framesDrawn = 0;
  /** Frames of the screen, whatever they show. */
  pictures = 0;
  readonly #latencies = new Float64Array(KEPT);
  readonly #sorted = new Float64Array(KEPT);
  #count = 0;
  #drawnStampS = NaN;

  drawn(stampS: number): void {
    this.framesDrawn += 1;
    this.#drawnStampS = stampS;
  }

  /** At the beginning of each frame of the screen. */
  presented(utcS: number): void {
    this.pictures += 1;
    if (Number.isNaN(this.#drawnStampS)) return;
    this.#latencies[this.#count % KEPT] = utcS - this.#drawnStampS;
    this.#count += 1;
    this.#drawnStampS = NaN;
  }

  /** Over the last frames [s]; NaN before there are any, and where the frames are not of this clock: a recording. */
  latency(share: number): number {
    const kept = Math.min(this.#count, KEPT);
    if (kept === 0) return NaN;
    this.#sorted.fill(Infinity).set(this.#latencies.subarray(0, kept));
    this.#sorted.sort();
    const value = this.#sorted[Math.min(kept - 1, Math.floor(share * kept))]!;
    return value > -1 && value < 10 ? value : NaN;
  }
}
