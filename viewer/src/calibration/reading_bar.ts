// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { element, setText } from "../dom";
import { fixed } from "../format";

const MOST_DECADES = 3;

/** How many times its unloaded reading a taxel reads, as a number and as a bar of its logarithm. */
export class ReadingBar {
  readonly element: HTMLElement;
  readonly #name = element("span");
  readonly #figure = element("span", { class: "figure", "data-role": "reading" });
  readonly #bar = element("div", { class: "reading-bar" });

  constructor() {
    this.element = element(
      "div",
      { class: "reading" },
      element("div", { class: "reading-head" }, this.#name, this.#figure),
      element("div", { class: "reading-track" }, this.#bar),
    );
  }

  set(name: string, reading: number): void {
    setText(this.#name, `Reading of ${name}`);
    setText(this.#figure, `${fixed(reading, reading < 9.95 ? 1 : 0)} \u00d7 unloaded`);
    const share = Math.log10(Math.max(1, reading)) / MOST_DECADES;
    this.#bar.style.width = `${(100 * Math.min(1, share)).toFixed(1)}%`;
  }
}
