// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { element, panel, setData, setText, table } from "../../dom";
import { timeOfDay, withUnit } from "../../format";
import { KeyedRows, type Row } from "../../keyed_rows";
import { stands, type Threat, ThreatState } from "../../messages/threat";

const { clear, crossed, active, latched } = ThreatState;
const STATE_WORDS: Record<number, string> = {
  [clear]: "below",
  [crossed]: "crossed",
  [active]: "threat",
  [latched]: "threat, until reset",
};
const STATE_LEVELS: Record<number, string> = { [clear]: "good", [crossed]: "warn", [active]: "bad", [latched]: "bad" };
const HEADS = ["Limit", "Where", "Quantity", "Limit at", "Now", "1 \u03c3", "State"];

class LimitRow implements Row<Threat> {
  readonly element: HTMLElement;
  readonly #cells = HEADS.slice(1).map((head) =>
    element("td", { class: "figure", "data-field": head === "State" ? "state" : undefined }),
  );

  constructor({ name }: Threat) {
    this.element = element("tr", { "data-limit": name }, element("th", { scope: "row" }, name), ...this.#cells);
  }

  show({ array, zone, quantity, limit, unit, value, sigma, state }: Threat): void {
    const texts = [
      zone === "" ? array : `${array}, ${zone}`,
      quantity.replaceAll("_", " "),
      withUnit(limit, unit),
      withUnit(value, unit),
      withUnit(sigma, unit),
      STATE_WORDS[state] ?? String(state),
    ];
    this.#cells.forEach((cell, column) => setText(cell, texts[column]!));
    setData(this.#cells.at(-1)!, "level", STATE_LEVELS[state] ?? "warn");
  }
}

/** How every limit stands. */
export class LimitTable {
  readonly element: HTMLElement;
  readonly #body = element("tbody", { "data-role": "limits" });
  readonly #rows = new KeyedRows<Threat>(
    this.#body,
    ({ array, name }) => `${array}/${name}`,
    (threat) => new LimitRow(threat),
  );
  readonly #none = element(
    "p",
    { class: "dim note" },
    "No limits are watched. Write them into a file, and serve it: dermis serve --threats limits.toml.",
  );

  constructor() {
    this.element = panel(
      [element("h2", {}, "Limits"), element("span", { class: "dim" }, "no safety function")],
      { "aria-label": "Limits" },
      table(HEADS, "", this.#body),
      this.#none,
    );
  }

  show(limits: readonly Threat[]): void {
    this.#rows.show(limits);
    this.#none.hidden = limits.length > 0;
  }
}

/** Beginnings and ends, the newest first. */
export class ThreatLog {
  readonly element: HTMLElement;
  readonly #list = element("ul", { class: "threat-log", "data-role": "threat-log" });

  constructor() {
    this.element = panel("Log", { "aria-label": "Log of threats" }, this.#list);
  }

  show(log: readonly Threat[]): void {
    if (log.length === 0) {
      this.#list.replaceChildren(element("li", { class: "dim" }, "Nothing has happened since this page was opened."));
      return;
    }
    this.#list.replaceChildren(
      ...log.map((threat) =>
        element(
          "li",
          { "data-level": stands(threat) ? "bad" : "good" },
          element("span", { class: "figure dim" }, timeOfDay(stands(threat) ? threat.crossedS : threat.stampS)),
          element("strong", {}, threat.name),
          element(
            "span",
            {},
            stands(threat)
              ? `${threat.array}: ${withUnit(threat.value, threat.unit)}, limit ${withUnit(threat.limit, threat.unit)}`
              : `${threat.array}: ended, at most ${withUnit(threat.worst, threat.unit)}`,
          ),
        ),
      ),
    );
  }
}
