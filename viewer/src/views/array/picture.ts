// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import type { ArrayLive } from "../../live/live_data";
import { type Contact, ContactPhase, ContactsFrame } from "../../messages/contacts";

/** A map that is so much older than what is known of the contacts has none drawn on it. */
export const STALE_S = 0.25;

/** The contacts of one moment, from which rings, labels, table and sums are drawn alike. */
export class Picture {
  contacts = new ContactsFrame();
  /** Those that touch in this frame, and still do so in the newest one. */
  touching: readonly Contact[] = [];
  /** The map is of this moment, so rings may stand on it. */
  isOnMap = false;
  readonly #paired = new ContactsFrame();

  /** Takes the contacts of the frame that the map shows; where there are none of it, the newest, which stand on no map. */
  take(live: ArrayLive, mapStampS: number): void {
    this.isOnMap = live.readAt(mapStampS, this.#paired) && live.contacts.stampS - mapStampS < STALE_S;
    this.contacts = this.isOnMap ? this.#paired : live.contacts;
    const newest = touchingIn(live.contacts);
    const lasting = new Set(newest.map(({ id }) => id));
    this.touching = touchingIn(this.contacts).filter(({ id }) => lasting.has(id));
  }

  /** Which contacts there are. */
  get key(): string {
    return this.touching.map(({ id }) => id).join(" ");
  }
}

export function touchingIn({ contacts, count }: ContactsFrame): Contact[] {
  return contacts.slice(0, count).filter(({ phase }) => phase !== ContactPhase.release);
}
