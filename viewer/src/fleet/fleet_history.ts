// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { element, setHidden, setText } from "../dom";
import { dateAndTime } from "../format";
import { KeyedRows, type Row } from "../keyed_rows";
import type { HistoryDocument, RobotEvent } from "./fleet_data";

const MOST_SHOWN = 200;
const MOST_WAIT_MS = 10000;

class EventRow implements Row<RobotEvent> {
  readonly #time = element("td", { class: "dim" });
  readonly #robot = element("th", { scope: "row", class: "told" });
  readonly #text = element("td", { class: "words told" });
  readonly element = element("tr", {}, this.#time, this.#robot, this.#text);

  show({ time_ms, robot, text }: RobotEvent): void {
    setText(this.#time, dateAndTime(time_ms / 1000));
    setText(this.#robot, robot);
    setText(this.#text, text);
  }
}

/** Changes of the last day, the newest first; asked for while it is open. */
export class FleetHistory {
  readonly element: HTMLDetailsElement;
  readonly #body = element("tbody");
  readonly #table = element(
    "table",
    { class: "table history-table", "aria-label": "Changes of the last day" },
    this.#body,
  );
  readonly #none = element("p", { class: "note dim" }, "Nothing has changed in the last day.");
  readonly #rows = new KeyedRows<RobotEvent>(
    this.#body,
    ({ time_ms, robot, text }) => `${time_ms} ${robot} ${text}`,
    () => new EventRow(),
  );
  #events: readonly RobotEvent[] = [];
  #words = "";

  constructor() {
    this.element = element(
      "details",
      { class: "panel history", "data-role": "history", ontoggle: () => void this.ask() },
      element("summary", {}, "What changed in the last day"),
      element(
        "div",
        { class: "table-room", tabindex: "0", role: "region", "aria-label": "History" },
        this.#table,
        this.#none,
      ),
    );
  }

  async ask(): Promise<void> {
    if (!this.element.open) return;
    const answer = await fetch(`history.json${window.location.search}`, {
      cache: "no-store",
      signal: AbortSignal.timeout(MOST_WAIT_MS),
    });
    if (!answer.ok) return;
    this.#events = ((await answer.json()) as HistoryDocument).events;
    this.#show();
  }

  /** Only changes of which robot or text have all these words. */
  filter(words: string): void {
    this.#words = words;
    this.#show();
  }

  #show(): void {
    const words = this.#words.toLowerCase().split(/\s+/);
    const isWanted = ({ robot, text }: RobotEvent): boolean =>
      words.every((word) => `${robot}\n${text}`.toLowerCase().includes(word));
    const shown = this.#events.filter(isWanted).slice(-MOST_SHOWN).reverse();
    this.#rows.show(shown);
    setHidden(this.#table, shown.length === 0);
    setHidden(this.#none, shown.length > 0);
  }
}
