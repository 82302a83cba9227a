// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { ContactPhase, ContactsFrame, readContacts, readContactsArray } from "../messages/contacts";
import type { Mark } from "../messages/mark";
import { type HealthStatus, readHealth, readStatistics, type Statistics } from "../messages/statistics";
import { readThreat, stands, type Threat } from "../messages/threat";
import { Signal } from "../signal";
import type { Stream } from "../stream/stream";
import type { Suit } from "../suit";
import { ContactSlots, Trail } from "./contact_slots";
import { Delay } from "./delay";
import { EventLog } from "./event_log";
import { ForceHistory } from "./force_history";
import { Marks } from "./marks";
import { RegionForce } from "./region_force";
import { ThreatBoard } from "./threat_board";

/** Half a second of contacts, and those that begin and end between the frames that are streamed. */
const MOST_RECENT = 64;

/** The data of one array, whatever is shown. */
export class ArrayLive {
  readonly contacts = new ContactsFrame();
  /** Rises with each message. */
  version = 0;
  /** The newest messages, by which a map finds the contacts of its frame. */
  readonly #recent: { stampS: number; message: DataView }[] = [];
  readonly total = new ForceHistory();
  readonly slots = new ContactSlots();
  /** Where the centre of pressure has been in the last two seconds, as long as something touches. */
  readonly centre = new Trail();

  receive(message: DataView): void {
    readContacts(message, this.contacts);
    const { stampS } = this.contacts;
    if (stampS < (this.#recent.at(-1)?.stampS ?? stampS)) this.#recent.length = 0;
    this.#recent.push({ stampS, message });
    if (this.#recent.length > MOST_RECENT) this.#recent.shift();
  }

  has(stampS: number): boolean {
    return this.#recent.some((one) => one.stampS === stampS);
  }

  /** False: there are no contacts of this very frame. */
  readAt(stampS: number, frame: ContactsFrame): boolean {
    const found = this.#recent.findLast((one) => one.stampS === stampS);
    if (found !== undefined) readContacts(found.message, frame);
    return found !== undefined;
  }

  /** The force of each contact, at its place: as /contacts gives it for the suit, in the plane of the array. */
  addCentre(): void {
    let [force, x, y] = [0, 0, 0];
    for (let index = 0; index < this.contacts.count; ++index) {
      const contact = this.contacts.contacts[index]!;
      if (contact.phase === ContactPhase.release) continue;
      force += contact.forceN;
      x += contact.forceN * contact.x;
      y += contact.forceN * contact.y;
    }
    if (force > 0) this.centre.add(this.contacts.stampS, x / force, y / force);
    else this.centre.clear();
  }
}

/** Messages that wait for the end of a pause: a minute of a suit. */
const MOST_HELD = 20000;

/** The topics that every view needs, followed from the beginning: contacts, threats, statistics, health. Contacts and
 *  the region stand still while the picture is paused, with all that is drawn of them; threats do not. */
export class LiveData {
  arrays: ArrayLive[] = [];
  readonly statistics = new Signal<Statistics | undefined>(undefined);
  readonly threats = new ThreatBoard();
  readonly events = new EventLog();
  readonly marks: Marks;
  readonly region: RegionForce;
  readonly health = new Signal<readonly HealthStatus[]>([]);
  /** Delay of the frames, also while the picture is paused. */
  readonly delay = new Delay();
  /** Time of the newest frame of any array. */
  latestS = 0;
  version = 0;
  #names: string[] = [];
  readonly #held: (() => void)[] = [];

  constructor(stream: Stream, suit: Suit, paused: Signal<boolean>) {
    const subscribe = (topic: string, handler: (message: DataView) => void): (() => void) =>
      stream.subscribe(topic, (message) => (paused.value ? this.#hold(() => handler(message)) : handler(message)));
    this.region = new RegionForce(subscribe);
    this.marks = new Marks(stream);
    this.marks.all.follow((marks) => this.#logMarks(marks));
    suit.description.follow(({ arrays }) => this.#restart(arrays.map(({ name }) => name)));
    subscribe("/contacts", (message) => this.#receive(message));
    stream.subscribe("/contacts", (_, logTimeS) => this.delay.add(logTimeS, performance.now()));
    paused.follow((isPaused) => !isPaused && this.#held.splice(0).forEach((receive) => receive()));
    stream.subscribe("/threat", (message) => this.threats.add(readThreat(message)));
    this.threats.log.follow(([newest]) => newest !== undefined && this.#logThreat(newest));
    stream.serverInfo.follow(() => {
      this.threats.restart();
      this.delay.restart();
    });
    stream.subscribe("/statistics", (message) => (this.statistics.value = readStatistics(message)));
    stream.subscribe("/health", (message) => (this.health.value = readHealth(message)));
  }

  #restart(names: string[]): void {
    if (names.join("/") === this.#names.join("/")) return;
    this.#names = names;
    this.arrays = names.map(() => new ArrayLive());
  }

  #hold(receive: () => void): void {
    this.#held.push(receive);
    if (this.#held.length > 2 * MOST_HELD) this.#held.splice(0, MOST_HELD);
  }

  #logThreat(threat: Threat): void {
    const isBegin = stands(threat);
    this.events.add(
      "threat",
      isBegin ? threat.crossedS : threat.stampS,
      isBegin ? threat.name : `${threat.name} over`,
      threat.array,
    );
  }

  #logMarks(marks: readonly Mark[]): void {
    this.events.marks = marks.map(({ atS, label, event }) => ({
      kind: event === "tare" ? "tare" : "mark",
      atS,
      words: event !== "" ? event : label === "" ? "the label ends" : label,
      array: "",
    }));
    this.version += 1;
  }

  #receive(message: DataView): void {
    const index = readContactsArray(message, this.#names);
    const array = this.arrays[index];
    if (array === undefined) return;
    const { contacts } = array;
    const beforeS = contacts.stampS;
    array.receive(message);
    array.total.add(contacts.stampS, contacts.totalForceN);
    const isRewound = contacts.stampS < Math.min(beforeS, this.latestS) - 1; // an array may lag behind the others
    if (isRewound) this.events.rewind(contacts.stampS);
    for (const id of array.slots.add(contacts))
      this.events.add("contact", contacts.stampS, `contact ${id}`, this.#names[index]);
    array.addCentre();
    array.version += 1;
    this.version += 1;
    if (contacts.stampS > this.latestS || isRewound) this.latestS = contacts.stampS;
  }
}
