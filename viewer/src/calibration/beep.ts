// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

const GAIN = 0.08;
const SECONDS = 0.12;

/** Short tones, because who presses looks at the array: high for done, low for a mistake. */
export class Beep {
  #context: AudioContext | undefined;

  /** To be called from a key or a click: browsers allow no sound before. */
  allow(): void {
    this.#context ??= new AudioContext();
    void this.#context.resume();
  }

  play(hertz: number): void {
    const context = this.#context;
    if (context === undefined) return;
    const tone = new OscillatorNode(context, { frequency: hertz });
    const gain = new GainNode(context, { gain: GAIN });
    tone.connect(gain).connect(context.destination);
    tone.start();
    gain.gain.setTargetAtTime(0, context.currentTime + SECONDS, 0.01);
    tone.stop(context.currentTime + 2 * SECONDS);
  }
}
