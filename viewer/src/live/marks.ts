// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { type Mark, readMark } from "../messages/mark";
import { Signal } from "../signal";
import type { Stream } from "../stream/stream";

interface ListedMark {
  time_s: number;
  label: string;
  event: string;
}

/** The marks of the server, which keeps them: live they are added, those of a recording are edited. */
export class Marks {
  /** By time. */
  readonly all = new Signal<readonly Mark[]>([]);
  readonly #stream: Stream;

  constructor(stream: Stream) {
    this.#stream = stream;
    stream.services.follow((services) => {
      // Lost with the connection, it is asked again with the next one.
      if (services.has("/marks/list")) this.#ask("/marks/list", {}, true).catch(() => undefined);
    });
    stream.subscribe("/marks", (message) => this.#take([...this.all.value, readMark(message)]));
  }

  /** Those of a recording, which are edited beside it. */
  get areEdited(): boolean {
    return this.#stream.services.value.has("/marks/set");
  }

  async add(atS: number, label = `mark ${this.all.value.length + 1}`): Promise<void> {
    if (this.areEdited) return this.replace([...this.all.value, { atS, label, event: "" }]);
    return this.#ask("/marks/add", { label, at_ms: Math.round(1000 * atS) }, false);
  }

  /** All of a recording from now on. */
  async replace(marks: readonly Mark[]): Promise<void> {
    const own = marks.filter(({ event }) => event === "").sort((a, b) => a.atS - b.atS);
    return this.#ask("/marks/set", { times_s: own.map(({ atS }) => atS), labels: own.map(({ label }) => label) }, true);
  }

  async #ask(service: string, request: object, isList: boolean): Promise<void> {
    const answer = (await this.#stream.callService(service, request)) as { marks: ListedMark[] };
    if (isList) this.#take(answer.marks.map(({ time_s, label, event }) => ({ atS: time_s, label, event })));
  }

  /** The server tells those of zeros again where a recording begins. */
  #take(marks: readonly Mark[]): void {
    const seen = new Set<string>();
    const isNew = ({ atS, label, event }: Mark): boolean => {
      const key = `${atS} ${event} ${label}`;
      if (seen.has(key)) return false;
      seen.add(key);
      return true;
    };
    this.all.value = marks.filter(isNew).sort((a, b) => a.atS - b.atS);
  }
}
