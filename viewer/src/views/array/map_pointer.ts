// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { type Region, regionBetween } from "../../live/region_force";
import type { Signal } from "../../signal";
import type { ArrayDescription } from "../../suit";
import { MOST_PINS } from "./taxel_table";

export interface PointerActions {
  /** -1: none. */
  taxelUnder(event: MouseEvent): number;
  /** The cursor is on another taxel, or the pins are others. */
  changed(): void;
  /** The cursor was moved by a key. */
  speak(): void;
  drawn(region: Region): void;
}

/** Cursor, pins, and the region that is being drawn: by pointer and by keys alike. */
export class MapPointer {
  cursor = -1;
  pins: number[] = [];
  readonly #actions: PointerActions;
  readonly #drawing: Signal<boolean>;
  #array: ArrayDescription | undefined;
  /** The first one of a region. */
  #corner = -1;
  #drewNow = false;

  constructor(room: HTMLElement, drawing: Signal<boolean>, actions: PointerActions) {
    this.#actions = actions;
    this.#drawing = drawing;
    room.addEventListener("pointermove", (event) => this.#move(actions.taxelUnder(event)));
    room.addEventListener("pointerleave", () => this.#move(-1));
    room.addEventListener("pointerdown", (event) => this.#press(room, event));
    room.addEventListener("pointerup", () => this.#release());
    room.addEventListener("pointercancel", () => (this.#corner = -1));
    room.addEventListener("click", (event) => this.#click(event));
    room.addEventListener("keydown", (event) => event.target === room && this.#steer(event));
    drawing.follow((isDrawing) => {
      this.#corner = -1;
      room.dataset.drawing = String(isDrawing);
      actions.changed();
    });
  }

  set array(array: ArrayDescription | undefined) {
    if (array?.name !== this.#array?.name) {
      this.pins = [];
      this.cursor = -1;
      this.#corner = -1;
    }
    this.#array = array;
  }

  /** The region as it would be if it ended here. */
  get preview(): Region | undefined {
    const isBegun = this.#corner >= 0 && this.cursor >= 0 && this.#array !== undefined;
    return isBegun ? regionBetween(this.#array!, this.#corner, this.cursor) : undefined;
  }

  #move(taxel: number): void {
    if (taxel === this.cursor) return;
    this.cursor = taxel;
    this.#actions.changed();
  }

  #press(room: HTMLElement, event: PointerEvent): void {
    this.#drewNow = false;
    const taxel = this.#drawing.value ? this.#actions.taxelUnder(event) : -1;
    if (taxel < 0) return;
    room.setPointerCapture(event.pointerId);
    this.#move(taxel);
    this.#corner = taxel;
  }

  #release(): void {
    if (this.#corner >= 0) this.#finish();
  }

  #click(event: MouseEvent): void {
    const isControl = event.target instanceof Element && event.target.closest("select, button") !== null;
    if (!isControl && !this.#drewNow && !this.#drawing.value) this.#pin(this.#actions.taxelUnder(event));
  }

  #finish(): void {
    const region = this.preview;
    this.#drewNow = true;
    this.#drawing.value = false;
    if (region !== undefined) this.#actions.drawn(region);
  }

  #pin(taxel: number): void {
    if (taxel < 0) return;
    const place = this.pins.indexOf(taxel);
    if (place >= 0) this.pins.splice(place, 1);
    else if (this.pins.length < MOST_PINS) this.pins.push(taxel);
    this.#actions.changed();
  }

  #enter(): void {
    this.#drewNow = false;
    if (!this.#drawing.value) this.#pin(this.cursor);
    else if (this.#corner >= 0) this.#finish();
    else this.#corner = this.cursor;
  }

  #steer(event: KeyboardEvent): void {
    const array = this.#array;
    if (array === undefined) return;
    const row = Math.floor(Math.max(0, this.cursor) / array.cols);
    const col = Math.max(0, this.cursor) % array.cols;
    const to = (newRow: number, newCol: number): void => {
      const inside =
        Math.min(array.rows - 1, Math.max(0, newRow)) * array.cols + Math.min(array.cols - 1, Math.max(0, newCol));
      this.#move(this.cursor < 0 ? 0 : inside);
    };
    if (event.key === "ArrowLeft") to(row, col - 1);
    else if (event.key === "ArrowRight") to(row, col + 1);
    else if (event.key === "ArrowUp") to(row - 1, col);
    else if (event.key === "ArrowDown") to(row + 1, col);
    else if (event.key === "Enter") this.#enter();
    else if (event.key === "Escape" && this.#drawing.value) this.#drawing.value = false;
    else if (event.key === "Escape") this.#move(-1);
    else return;
    event.preventDefault();
    event.stopPropagation();
    this.#actions.speak();
  }
}
