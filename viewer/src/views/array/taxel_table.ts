// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { element, panel, setData, setHidden, setText, table } from "../../dom";
import { engineering, fixed, statusWord } from "../../format";
import type { GridFrame } from "../../messages/grids";
import type { ArrayDescription } from "../../suit";
import { taxelName } from "./geometry";
import { ohms, taxelAreaM2 } from "./quantities";

export const MOST_PINS = 6;
const COLUMNS = ["counts", "ohms", "siemens", "newtons", "sigma", "pressure", "status"] as const;

export interface Frames {
  raw: GridFrame;
  conductance: GridFrame;
  force: GridFrame;
}

class Row {
  readonly element: HTMLTableRowElement;
  readonly #name = element("th", { scope: "row" });
  readonly #cells = new Map<string, HTMLElement>();

  constructor(role: string) {
    this.element = element("tr", { "data-role": role }, this.#name);
    for (const column of COLUMNS) {
      const cell = element("td", { "data-field": column, class: column === "status" ? "" : "figure" });
      this.#cells.set(column, cell);
      this.element.append(cell);
    }
  }

  show(label: string, taxel: number, array: ArrayDescription, { raw, conductance, force }: Frames): void {
    setText(this.#name, label);
    setData(this.element, "taxel", taxelName(taxel, array));
    if (!array.calibrated) {
      this.#showCounts(valueAt(raw, taxel));
      return;
    }
    const siemens = valueAt(conductance, taxel);
    const status = force.statuses[taxel] ?? conductance.statuses[taxel] ?? 0;
    this.#set("counts", fixed(valueAt(raw, taxel), Number.isInteger(valueAt(raw, taxel)) ? 0 : 1));
    this.#set("ohms", Number.isNaN(siemens) ? fixed(NaN, 0) : ohms(siemens));
    this.#set("siemens", Number.isNaN(siemens) ? fixed(NaN, 0) : engineering(siemens, "S"));
    this.#set("newtons", `${fixed(valueAt(force, taxel), 3)} N`);
    this.#set("sigma", `\u00b1 ${fixed(force.sigmas[taxel] ?? NaN, 3)} N`);
    this.#set("pressure", `${fixed((1e-3 * valueAt(force, taxel)) / taxelAreaM2(array), 1)} kPa`);
    this.#set("status", statusWord(status));
    setData(this.element, "status", statusWord(status));
  }

  /** All that is known of an array without a model. */
  #showCounts(counts: number): void {
    delete this.element.dataset.status;
    for (const column of COLUMNS) this.#set(column, "");
    this.#set("counts", fixed(counts, Number.isInteger(counts) ? 0 : 1));
    this.#set("status", "not calibrated");
  }

  #set(column: string, text: string): void {
    setText(this.#cells.get(column)!, text);
  }
}

function valueAt(frame: GridFrame, taxel: number): number {
  return frame.values[taxel] ?? NaN;
}

/** The readings of the taxel under the cursor and of the pinned ones. */
export class TaxelTable {
  readonly element: HTMLElement;
  readonly #cursor = new Row("cursor");
  readonly #none = element(
    "p",
    { class: "dim note" },
    "Point at a taxel to read it here. A click keeps it, up to six.",
  );
  readonly #pins = Array.from({ length: MOST_PINS }, (_, index) => new Row(`pin-${index + 1}`));

  constructor() {
    const heads = ["Taxel", "Counts", "Resist.", "Conduct.", "Force", "\u00b1", "Pressure", "Status"];
    const body = element("tbody", {}, this.#cursor.element, ...this.#pins.map((row) => row.element));
    const room = table(heads, "taxel-table", body);
    room.append(this.#none);
    this.element = panel("Taxels", {}, room);
  }

  show(array: ArrayDescription, frames: Frames, cursor: number, pins: readonly number[]): void {
    setHidden(this.#cursor.element, cursor < 0);
    setHidden(this.#none, cursor >= 0 || pins.length > 0);
    if (cursor >= 0) this.#cursor.show(taxelName(cursor, array), cursor, array, frames);
    this.#pins.forEach((row, index) => {
      const taxel = pins[index];
      row.element.hidden = taxel === undefined;
      if (taxel !== undefined) row.show(`${index + 1}  ${taxelName(taxel, array)}`, taxel, array, frames);
    });
  }
}
