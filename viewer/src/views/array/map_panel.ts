// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { element, panel, setText } from "../../dom";
import type { GridFrame } from "../../messages/grids";
import { setting } from "../../settings";
import type { Signal } from "../../signal";
import type { ArrayDescription } from "../../suit";
import { highestOf } from "./feeds";
import { endLabel, endThatHolds, type Quantity, shownUnit } from "./quantities";
import { SteppedEnd } from "./stepped_end";

const TICKS = 4;
/** Choices beside an end: as the quantity has it first; in steps, by itself; an end that holds what is there now. */
const FIRST = 0;
const STEPS = -1;
const FIT = -2;
const SAY_MS = 6000;

/** The frame of one map: its title, the place where it is drawn, its scale with ticks, and the choice of the scale's end. */
export class MapPanel {
  readonly element: HTMLElement;
  readonly plot = element("div", { class: "map-plot" });
  readonly quantity: Quantity;
  readonly end: Signal<number>;
  readonly #select: HTMLSelectElement;
  readonly #unit = element("span", { class: "dim" });
  readonly #said = element("span", { class: "scale-said", role: "status", "data-role": "scale-said" });
  readonly #stepped = new SteppedEnd();
  #array: ArrayDescription | undefined;
  #seen: GridFrame | undefined;
  #sayTimer = 0;
  readonly #ticks: HTMLElement[] = [];

  constructor(quantity: Quantity) {
    this.quantity = quantity;
    this.end = setting<number>(`scale.${quantity.name}`, FIRST, (value) => value >= STEPS);
    this.#select = element("select", {
      class: "field compact",
      "aria-label": `End of the scale of ${quantity.title}`,
      "data-role": `scale-${quantity.name}`,
      onchange: () => this.#choose(Number(this.#select.value)),
    });
    const strip = element("div", { class: "scale-strip" });
    const ticks = element("div", { class: "scale-ticks figure" });
    for (let tick = 0; tick <= TICKS; ++tick) {
      const label = element("span", { style: `left: ${(100 * tick) / TICKS}%` });
      this.#ticks.push(label);
      ticks.append(label);
    }
    this.element = panel(
      [element("h2", {}, quantity.title), this.#unit, this.#said, this.#select],
      { class: "map-panel", "data-quantity": quantity.name, "aria-label": `${quantity.title} map` },
      this.plot,
      element("div", { class: "scale" }, strip, ticks),
    );
  }

  /** The end of the scale for this array. */
  endFor(array: ArrayDescription): number {
    if (this.end.value === STEPS && this.#stepped.value > 0) return this.#stepped.value;
    const ends = this.quantity.ends(array);
    return ends.includes(this.end.value) ? this.end.value : this.quantity.firstEnd(array);
  }

  describe(array: ArrayDescription): void {
    if (array.name !== this.#array?.name) this.#stepped.restart();
    this.#array = array;
    const end = this.endFor(array);
    this.#offer(this.quantity.ends(array), end);
    setText(this.#unit, shownUnit(this.quantity, end));
    this.#ticks.forEach((label, tick) => setText(label, this.quantity.label((end * tick) / TICKS, end)));
  }

  /** Options that are there already stay. */
  #offer(ends: readonly number[], end: number): void {
    const isStepped = this.end.value === STEPS;
    const wanted: (readonly [number, string])[] = [
      [STEPS, isStepped ? `steps: 0 \u2013 ${endLabel(this.quantity, end)}` : "in steps, by itself"],
      [FIT, "fit now"],
      ...ends.map((value) => [value, `0 \u2013 ${endLabel(this.quantity, value)}`] as const),
    ];
    const { options } = this.#select;
    while (options.length > wanted.length) options.remove(options.length - 1);
    wanted.forEach(([value, words], index) => {
      const option = options[index] ?? this.#select.appendChild(element("option"));
      option.value = String(value);
      setText(option, words);
    });
    this.#select.value = String(isStepped ? STEPS : end);
  }

  /** Takes the next frame to draw. True: the scale has another end now. */
  see(frame: GridFrame): boolean {
    if (this.#array === undefined) return false;
    this.#seen = frame;
    if (this.end.value !== STEPS) return false;
    const before = this.#stepped.value;
    if (!this.#stepped.see(highestOf(frame), frame.stampS, this.quantity.ends(this.#array))) return false;
    if (before > 0) this.#sayBefore(before);
    return true;
  }

  #choose(choice: number): void {
    const array = this.#array;
    if (array === undefined) return;
    this.#stepped.restart();
    const highest = choice === FIT && this.#seen !== undefined ? highestOf(this.#seen) : 0;
    this.end.value = choice === FIT ? endThatHolds(highest, this.quantity.ends(array)) : choice;
    this.describe(array);
  }

  /** The unit, too, where it is another now. */
  #sayBefore(before: number): void {
    const isOtherUnit = shownUnit(this.quantity, before) !== shownUnit(this.quantity, this.#stepped.value);
    window.clearTimeout(this.#sayTimer);
    setText(this.#said, `was ${isOtherUnit ? endLabel(this.quantity, before) : this.quantity.label(before, before)}`);
    this.#sayTimer = window.setTimeout(() => setText(this.#said, ""), SAY_MS);
  }
}
