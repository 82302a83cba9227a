// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { element, setText } from "../../dom";
import { setting } from "../../settings";
import type { Signal } from "../../signal";
import type { ArrayDescription } from "../../suit";
import { endLabel, type Quantity, shownUnit } from "./quantities";

const TICKS = 4;

/** The frame of one map: its title, the place where it is drawn, its scale with ticks, and the choice of the scale's end. */
export class MapPanel {
  readonly element: HTMLElement;
  readonly plot = element("div", { class: "map-plot" });
  readonly quantity: Quantity;
  readonly end: Signal<number>;
  readonly #select: HTMLSelectElement;
  readonly #unit = element("span", { class: "dim" });
  readonly #ticks: HTMLElement[] = [];

  constructor(quantity: Quantity) {
    this.quantity = quantity;
    // 0: as the quantity has it first.
    this.end = setting<number>(`scale.${quantity.name}`, 0, (value) => value >= 0);
    this.#select = element("select", {
      class: "field compact",
      "aria-label": `End of the scale of ${quantity.title}`,
      "data-role": `scale-${quantity.name}`,
      onchange: () => (this.end.value = Number(this.#select.value)),
    });
    const strip = element("div", { class: "scale-strip" });
    const ticks = element("div", { class: "scale-ticks figure" });
    for (let tick = 0; tick <= TICKS; ++tick) {
      const label = element("span", { style: `left: ${(100 * tick) / TICKS}%` });
      this.#ticks.push(label);
      ticks.append(label);
    }
    this.element = element(
      "section",
      { class: "panel map-panel", "aria-label": `${quantity.title} map` },
      element("header", { class: "panel-title" }, element("h2", {}, quantity.title), this.#unit, this.#select),
      this.plot,
      element("div", { class: "scale" }, strip, ticks),
    );
  }

  /** The end of the scale for this array. */
  endFor(array: ArrayDescription): number {
    const ends = this.quantity.ends(array);
    return ends.includes(this.end.value) ? this.end.value : this.quantity.firstEnd(array);
  }

  describe(array: ArrayDescription): void {
    const end = this.endFor(array);
    const ends = this.quantity.ends(array);
    if (!ends.includes(end)) ends.push(end);
    ends.sort((a, b) => a - b);
    this.#select.replaceChildren(
      ...ends.map((value) => element("option", { value, selected: value === end }, `0 \u2013 ${endLabel(this.quantity, value)}`)),
    );
    setText(this.#unit, shownUnit(this.quantity, end));
    this.#ticks.forEach((label, tick) => setText(label, this.quantity.label((end * tick) / TICKS, end)));
  }
}
