// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { ContactsFrame, readContacts, readContactsArray } from "../messages/contacts";
import { type HealthStatus, type Statistics, readHealth, readStatistics } from "../messages/statistics";
import { Signal } from "../signal";
import type { Stream } from "../stream/stream";
import type { Suit } from "../suit";
import { readThreat } from "../messages/threat";
import { ContactSlots } from "./contact_slots";
import { ForceHistory } from "./force_history";
import { ThreatBoard } from "./threat_board";

/** What is known of one array, whatever is shown. */
export class ArrayLive {
  readonly contacts = new ContactsFrame();
  /** Rises with each message. */
  version = 0;
  readonly total = new ForceHistory();
  readonly slots = new ContactSlots();
}

/** Messages that wait for the end of a pause: a minute of a suit. */
const MOST_HELD = 20000;

/** What is followed from the beginning, as every view needs it: contacts, threats, statistics, health. Contacts stand
 *  still while the picture is paused, with all that is drawn of them; threats do not. */
export class LiveData {
  arrays: ArrayLive[] = [];
  readonly statistics = new Signal<Statistics | undefined>(undefined);
  readonly threats = new ThreatBoard();
  readonly health = new Signal<readonly HealthStatus[]>([]);
  /** Time of the newest frame of any array. */
  latestS = 0;
  version = 0;
  #names: string[] = [];
  readonly #held: DataView[] = [];

  constructor(stream: Stream, suit: Suit, paused: Signal<boolean>) {
    suit.description.follow(({ arrays }) => this.#restart(arrays.map(({ name }) => name)));
    stream.subscribe("/contacts", (message) => (paused.value ? this.#hold(message) : this.#receive(message)));
    paused.follow((isPaused) => !isPaused && this.#held.splice(0).forEach((message) => this.#receive(message)));
    stream.subscribe("/threat", (message) => this.threats.add(readThreat(message)));
    stream.serverInfo.follow(() => this.threats.restart());
    stream.subscribe("/statistics", (message) => (this.statistics.value = readStatistics(message)));
    stream.subscribe("/health", (message) => (this.health.value = readHealth(message)));
  }

  #restart(names: string[]): void {
    if (names.join("/") === this.#names.join("/")) return;
    this.#names = names;
    this.arrays = names.map(() => new ArrayLive());
  }

  #hold(message: DataView): void {
    this.#held.push(message);
    if (this.#held.length > 2 * MOST_HELD) this.#held.splice(0, MOST_HELD);
  }

  #receive(message: DataView): void {
    const array = this.arrays[readContactsArray(message, this.#names)];
    if (array === undefined) return;
    const { contacts } = array;
    readContacts(message, contacts);
    array.total.add(contacts.stampS, contacts.totalForceN);
    array.slots.add(contacts);
    array.version += 1;
    this.version += 1;
    if (contacts.stampS > this.latestS || contacts.stampS < this.latestS - 1) this.latestS = contacts.stampS;
  }
}
