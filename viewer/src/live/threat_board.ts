// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { stands, type Threat } from "../messages/threat";
import { Signal } from "../signal";

const MOST_ENTRIES = 200;

/** How every limit stands, what stood when the page was opened, and what began and ended since. */
export class ThreatBoard {
  /** The newest message of each array and limit, in the order in which they came first. */
  readonly limits = new Signal<readonly Threat[]>([]);
  /** Beginnings and ends, the newest first. */
  readonly log = new Signal<readonly Threat[]>([]);
  readonly #byLimit = new Map<string, Threat>();

  add(threat: Threat): void {
    const key = `${threat.array}/${threat.name}`;
    const before = this.#byLimit.get(key);
    this.#byLimit.set(key, threat);
    this.limits.value = [...this.#byLimit.values()];
    const wasMissed =
      before === undefined ? stands(threat) && !this.#isLogged(threat) : stands(before) !== stands(threat);
    if (threat.changed || wasMissed) this.log.value = [threat, ...this.log.value].slice(0, MOST_ENTRIES);
  }

  #isLogged({ name, array, crossedS }: Threat): boolean {
    return this.log.value.some(
      (entry) => stands(entry) && entry.name === name && entry.array === array && entry.crossedS === crossedS,
    );
  }

  /** Another connection: what stood before may have ended. The log stays. */
  restart(): void {
    this.#byLimit.clear();
    this.limits.value = [];
  }

  get standing(): Threat[] {
    return this.limits.value.filter(stands);
  }
}
