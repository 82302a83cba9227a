// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { element, setData, setText } from "../../dom";
import { timeOfDay, withUnit } from "../../format";
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

/** How every limit stands. */
export class LimitTable {
  readonly element: HTMLElement;
  readonly #rows = element("tbody", { "data-role": "limits" });
  readonly #none = element(
    "p",
    { class: "dim note" },
    "No limits are watched: write them (docs/threats.md) and serve them (dermis serve --threats).",
  );
  #names = "";

  constructor() {
    const head = element("thead", {}, element("tr", {}, ...HEADS.map((text) => element("th", { scope: "col" }, text))));
    this.element = element(
      "section",
      { class: "panel", "aria-label": "Limits" },
      element(
        "header",
        { class: "panel-title" },
        element("h2", {}, "Limits"),
        element("span", { class: "dim" }, "no safety function"),
      ),
      element("div", { class: "table-room" }, element("table", { class: "table" }, head, this.#rows)),
      this.#none,
    );
  }

  show(limits: readonly Threat[]): void {
    const names = limits.map(({ name, array }) => `${array}/${name}`).join("\n");
    if (names !== this.#names) {
      this.#names = names;
      this.#rows.replaceChildren(
        ...limits.map(({ name }) =>
          element(
            "tr",
            { "data-limit": name },
            element("th", { scope: "row" }, name),
            ...HEADS.slice(1).map(() => element("td", { class: "figure" })),
          ),
        ),
      );
    }
    this.#none.hidden = limits.length > 0;
    limits.forEach((threat, row) => this.#showRow(this.#rows.children[row] as HTMLElement, threat));
  }

  #showRow(row: HTMLElement, { array, zone, quantity, limit, unit, value, sigma, state }: Threat): void {
    const texts = [
      zone === "" ? array : `${array}, ${zone}`,
      quantity.replaceAll("_", " "),
      withUnit(limit, unit),
      withUnit(value, unit),
      withUnit(sigma, unit),
      STATE_WORDS[state] ?? String(state),
    ];
    texts.forEach((text, column) => setText(row.children[column + 1] as HTMLElement, text));
    const last = row.lastElementChild as HTMLElement;
    setData(last, "field", "state");
    setData(last, "level", STATE_LEVELS[state] ?? "warn");
  }
}

/** Beginnings and ends, the newest first. */
export class ThreatLog {
  readonly element: HTMLElement;
  readonly #list = element("ul", { class: "threat-log", "data-role": "threat-log" });

  constructor() {
    this.element = element(
      "section",
      { class: "panel", "aria-label": "Log of threats" },
      element("header", { class: "panel-title" }, element("h2", {}, "Log")),
      this.#list,
    );
  }

  show(log: readonly Threat[]): void {
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
