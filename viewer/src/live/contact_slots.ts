// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { type Contact, ContactPhase, type ContactsFrame } from "../messages/contacts";
import { ForceHistory } from "./force_history";

/** So many contacts of an array at once have a colour, a trail and a line in the plot. */
export const SLOTS = 8;
/** Two seconds. */
const TRAIL_POINTS = 48;
const TRAIL_STEP_S = 1 / 24;

/** Where something has been: the last so many points, 24 a second. */
export class Trail {
  readonly #xs = new Float32Array(TRAIL_POINTS);
  readonly #ys = new Float32Array(TRAIL_POINTS);
  #count = 0;
  #lastS = -Infinity;

  clear(): void {
    this.#count = 0;
    this.#lastS = -Infinity;
  }

  add(stampS: number, x: number, y: number): void {
    if (stampS < this.#lastS) this.clear();
    if (stampS - this.#lastS < TRAIL_STEP_S) return;
    this.#xs[this.#count % this.#xs.length] = x;
    this.#ys[this.#count % this.#ys.length] = y;
    this.#count += 1;
    this.#lastS = stampS;
  }

  get length(): number {
    return Math.min(this.#count, this.#xs.length);
  }

  /** From the oldest, 0, on. */
  x(index: number): number {
    return this.#xs[(this.#count - this.length + index) % this.#xs.length]!;
  }

  y(index: number): number {
    return this.#ys[(this.#count - this.length + index) % this.#xs.length]!;
  }
}

export class ContactSlot {
  /** 0: free. */
  id = 0;
  readonly trail = new Trail();
  readonly history = new ForceHistory();
}

/** Gives each contact of an array a slot for as long as it lasts. */
export class ContactSlots {
  readonly slots: readonly ContactSlot[] = Array.from({ length: SLOTS }, () => new ContactSlot());

  /** The contacts that began with this frame. */
  add(frame: ContactsFrame): number[] {
    const begun: number[] = [];
    for (const slot of this.slots) {
      const contact = slot.id === 0 ? undefined : find(frame, slot.id);
      if (contact === undefined) {
        if (slot.id !== 0) slot.trail.clear();
        slot.id = 0;
        slot.history.add(frame.stampS, NaN);
      }
    }
    for (let index = 0; index < frame.count; ++index) {
      const contact = frame.contacts[index]!;
      if (contact.phase === ContactPhase.onset && this.indexOf(contact.id) < 0) begun.push(contact.id);
      this.#update(frame.stampS, contact);
    }
    return begun;
  }

  /** -1: the contact has none. */
  indexOf(id: number): number {
    for (let index = 0; index < SLOTS; ++index) if (this.slots[index]!.id === id) return index;
    return -1;
  }

  #update(stampS: number, contact: Contact): void {
    const index = this.indexOf(contact.id);
    const slot = this.slots[index >= 0 ? index : this.indexOf(0)];
    if (slot === undefined) return;
    slot.id = contact.id;
    slot.trail.add(stampS, contact.x, contact.y);
    slot.history.add(stampS, contact.forceN);
  }
}

function find(frame: ContactsFrame, id: number): Contact | undefined {
  for (let index = 0; index < frame.count; ++index) {
    if (frame.contacts[index]!.id === id) return frame.contacts[index];
  }
  return undefined;
}
