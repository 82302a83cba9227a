// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { element, panel, setData, setHidden, setText, table } from "../../dom";
import { fixed, measured } from "../../format";
import { type ContactSlots, SLOTS } from "../../live/contact_slots";
import type { Contact } from "../../messages/contacts";
import type { Picture } from "./picture";

const HEADS = ["Id", "Force", "\u00b1", "x", "y", "Area", "Peak", "Held"];
const UNITS = ["", "N", "N", "mm", "mm", "mm\u00b2", "kPa", "s"];

class Row {
  readonly element: HTMLTableRowElement;
  readonly #swatch = element("span", { class: "swatch" });
  readonly #id = element("span");
  readonly #cells: HTMLElement[] = [];

  constructor() {
    this.element = element("tr", {}, element("th", { scope: "row", class: "figure" }, this.#swatch, this.#id));
    for (const name of ["force", "sigma", "x", "y", "area", "peak", "held"]) {
      const cell = element("td", { class: "figure", "data-field": name });
      this.#cells.push(cell);
      this.element.append(cell);
    }
  }

  show(contact: Contact, slot: number, stampS: number): void {
    setData(this.element, "contact", String(contact.id));
    setText(this.#id, String(contact.id));
    const color = slot >= 0 ? `var(--series-${slot + 1})` : "var(--text-dim)";
    if (this.#swatch.style.background !== color) this.#swatch.style.background = color;
    const [force, sigma] = measured(contact.forceN, contact.sigmaForceN);
    this.#set(0, force);
    this.#set(1, sigma);
    this.#set(2, fixed(1e3 * contact.x, 2));
    this.#set(3, fixed(1e3 * contact.y, 2));
    this.#set(4, fixed(1e6 * contact.areaM2, 0));
    this.#set(5, fixed(1e-3 * contact.peakPressurePa, 1));
    this.#set(6, fixed(stampS - contact.onsetS, 1));
  }

  #set(index: number, text: string): void {
    setText(this.#cells[index]!, text);
  }
}

/** The contacts of the array, by id. */
export class ContactTable {
  readonly element: HTMLElement;
  readonly #rows = Array.from({ length: SLOTS }, () => new Row());
  readonly #more = element("p", { class: "dim note" });

  constructor() {
    const heads = HEADS.map((head, index) => [head, element("span", { class: "unit" }, UNITS[index]!)]);
    const body = element("tbody", { "data-role": "contacts" }, ...this.#rows.map((row) => row.element));
    const room = table(heads, "contact-table", body);
    room.tabIndex = 0;
    room.role = "region";
    room.ariaLabel = "The contacts that are shown";
    room.append(this.#more);
    this.element = panel("Contacts", {}, room);
  }

  show({ contacts, touching }: Picture, slots: ContactSlots, isCalibrated: boolean): void {
    const listed = touching.slice(0, SLOTS);
    listed.forEach((contact, index) => this.#rows[index]!.show(contact, slots.indexOf(contact.id), contacts.stampS));
    this.#rows.forEach((row, index) => setHidden(row.element, index >= listed.length));
    const hidden = touching.length - listed.length;
    const none = isCalibrated
      ? "Nothing touches this array. Press it: each touch gets a line here."
      : "Touches are found by their forces: calibrate first.";
    setText(this.#more, listed.length === 0 ? none : hidden > 0 ? `and ${hidden} more` : "");
  }
}
