// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { button, element, setData, setHidden, setText } from "../dom";
import { count } from "../format";
import { KeyedRows } from "../keyed_rows";
import { Theme } from "../theme";
import {
  aged,
  type FleetDocument,
  isOfKind,
  isWanted,
  KINDS,
  type Kind,
  type Order,
  type Robot,
  type RobotState,
  robotOf,
  type SortKey,
  sorted,
} from "./fleet_data";
import { FleetHistory } from "./fleet_history";
import { COLUMNS, RobotRow } from "./robot_row";
import "./fleet.css";

const PERIOD_MS = 2000;
const MOST_WAIT_MS = 10000;
const KIND_WORDS: Readonly<Record<Kind, string>> = {
  all: "All",
  attention: "Attention",
  silent: "Silent",
  "to calibrate": "To calibrate",
};

/** Where the hub is, without the key that opens it: "hub.local:4222" of nats://hub.local:4222?key=/etc/fleet.pem. */
function hubName(address: string): string {
  return address.replace(/[?#].*$/, "").replace(/^\w+:\/+/, "");
}

/** The robots of a hub, asked for again and again. */
export class FleetPage {
  readonly #theme = new Theme();
  readonly #pill = element("span", { class: "pill", "data-role": "connection", role: "status" });
  readonly #hub = element("span", { class: "dim hub", "data-role": "hub" });
  readonly #notice = element("p", { class: "notice", role: "alert", "data-role": "notice", hidden: true });
  readonly #words = element("input", {
    type: "search",
    class: "field words-field",
    placeholder: "Filter  /",
    "aria-label": "Filter by robot, array or remark",
    "data-role": "filter",
    oninput: () => this.#show(),
  });
  readonly #kinds: ReadonlyMap<Kind, HTMLButtonElement>;
  readonly #heads: readonly HTMLElement[];
  readonly #table: HTMLTableElement;
  readonly #room: HTMLElement;
  readonly #none = element("p", { class: "note dim", "data-role": "none", hidden: true });
  readonly #shownCount = element("span", { class: "dim", role: "status", "data-role": "shown" });
  readonly #rows: KeyedRows<Robot>;
  readonly #history = new FleetHistory();
  #robots: readonly Robot[] = [];
  #told: { readonly states: readonly RobotState[]; readonly at: number } = { states: [], at: 0 };
  #isThere = false;
  #kind: Kind = "all";
  #order: Order = { key: "state", descends: false };

  constructor() {
    this.#kinds = new Map(
      KINDS.map((kind) => [kind, button("", () => this.#choose(kind), { "data-kind": kind, class: "compact" })]),
    );
    this.#heads = COLUMNS.map(({ key, name, title }) =>
      element(
        "th",
        { role: "columnheader", scope: "col", title, "data-head": name },
        key === undefined
          ? name
          : element("button", { type: "button", class: "sort", onclick: () => this.#sort(key) }, name),
      ),
    );
    const head = element("thead", { role: "rowgroup" }, element("tr", { role: "row" }, ...this.#heads));
    this.#table = element("table", { role: "table", class: "table fleet-table", "aria-label": "Robots" }, head);
    this.#room = element("div", {
      class: "table-room",
      tabindex: "0",
      role: "region",
      "aria-label": "Table of robots",
    });
    this.#room.append(this.#table, this.#none);
    this.#rows = new KeyedRows(
      this.#table,
      ({ state }) => state.name,
      () => new RobotRow(() => this.#hub.title),
    );
  }

  begin(): void {
    document.body.classList.add("fleet");
    document.body.append(
      this.#bar(),
      this.#notice,
      element("main", {}, this.#toolbar(), this.#panel(), this.#history.element),
    );
    window.addEventListener("keydown", (event) => this.#key(event));
    this.#show();
    void this.#follow();
  }

  #bar(): HTMLElement {
    return element(
      "header",
      { class: "bar" },
      element("span", { class: "brand" }, "dermis"),
      element("h1", {}, "Fleet"),
      this.#hub,
      element("span", { class: "stretch" }),
      this.#pill,
      button("\u25d0", () => this.#theme.toggle(), {
        class: "icon",
        "aria-label": "Light or dark",
        title: "Light or dark (D)",
      }),
    );
  }

  #toolbar(): HTMLElement {
    const kinds = element("div", { class: "group", role: "group", "aria-label": "Kind" }, ...this.#kinds.values());
    const order = element(
      "select",
      {
        class: "field compact order-field",
        "aria-label": "Order",
        "data-role": "order",
        onchange: (event) => this.#sort((event.target as HTMLSelectElement).value as SortKey),
      },
      ...COLUMNS.flatMap(({ key, name }) =>
        key === undefined ? [] : [element("option", { value: key }, `By ${name.toLowerCase()}`)],
      ),
    );
    return element("div", { class: "toolbar" }, this.#words, kinds, order, this.#shownCount);
  }

  #panel(): HTMLElement {
    return element("section", { class: "panel", "aria-label": "Robots" }, this.#room);
  }

  /** Asks, shows, waits, for ever. */
  async #follow(): Promise<void> {
    while (true) {
      await this.#ask();
      this.#age();
      await new Promise((later) => setTimeout(later, PERIOD_MS));
    }
  }

  async #ask(): Promise<void> {
    try {
      const answer = await fetch(`fleet.json${window.location.search}`, {
        cache: "no-store",
        signal: AbortSignal.timeout(MOST_WAIT_MS),
      });
      if (answer.status === 401)
        return this.#say("bad", "Wrong token", "Open the address that dermis fleet page printed.");
      if (!answer.ok) return this.#say("bad", "No answer", `The server answers with ${answer.status}.`);
      this.#take((await answer.json()) as FleetDocument);
      await this.#history.ask();
    } catch {
      this.#say("bad", "No server", "dermis fleet page does not answer; it is asked again.");
    }
  }

  #take(fleet: FleetDocument): void {
    this.#isThere = true;
    setText(this.#hub, hubName(fleet.hub));
    this.#hub.title = fleet.hub;
    this.#told = { states: fleet.robots, at: performance.now() };
    if (fleet.error !== "") this.#say("bad", "No hub", `${fleet.error}. The table is as the hub told it last.`);
    else if (fleet.full !== "") this.#say("bad", "Disk full", fleet.full);
    else this.#say("good", "Live", "");
  }

  /** The last answer is older now. */
  #age(): void {
    const seconds = (performance.now() - this.#told.at) / 1000;
    this.#robots = this.#told.states.map((state) => robotOf(aged(state, seconds)));
    this.#show();
  }

  #say(level: string, words: string, line: string): void {
    setData(document.documentElement, "connection", level === "good" ? "live" : "lost");
    setData(this.#pill, "level", level);
    setText(this.#pill, words);
    setText(this.#notice, line);
    setData(this.#notice, "level", level);
    setHidden(this.#notice, line === "");
  }

  #show(): void {
    const wanted = { words: this.#words.value.trim(), kind: this.#kind };
    const robots = sorted(
      this.#robots.filter((robot) => isWanted(robot, wanted)),
      this.#order,
    );
    this.#rows.show(robots);
    this.#history.filter(wanted.words);
    this.#kinds.forEach((kindButton, kind) => {
      const ofKind = this.#robots.filter((robot) => isOfKind(robot, kind)).length;
      setText(kindButton, `${KIND_WORDS[kind]} ${count(ofKind)}`);
      kindButton.setAttribute("aria-pressed", String(kind === this.#kind));
    });
    COLUMNS.forEach(({ key }, index) => this.#showOrder(this.#heads[index]!, key));
    const isPart = robots.length < this.#robots.length;
    setText(this.#shownCount, isPart ? `${count(robots.length)} of ${count(this.#robots.length)} shown` : "");
    setHidden(this.#table, robots.length === 0);
    setHidden(this.#none, robots.length > 0);
    setText(this.#none, this.#emptyWords());
  }

  #emptyWords(): string {
    if (!this.#isThere) return "Waiting for the hub.";
    if (this.#robots.length > 0) return "No robot is of this kind and has these words.";
    return "The hub knows no robot yet: dermis fleet add HUB --robot NAME.";
  }

  #showOrder(head: HTMLElement, key: SortKey | undefined): void {
    if (key === this.#order.key) head.setAttribute("aria-sort", this.#order.descends ? "descending" : "ascending");
    else head.removeAttribute("aria-sort");
  }

  #choose(kind: Kind): void {
    this.#kind = kind;
    this.#show();
  }

  /** Figures begin with the greatest. A second time turns the order round. */
  #sort(key: SortKey): void {
    const isTurned = this.#order.key === key;
    this.#order = { key, descends: isTurned ? !this.#order.descends : key !== "state" && key !== "robot" };
    document.querySelector<HTMLSelectElement>("[data-role=order]")!.value = key;
    this.#show();
  }

  #key(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const isTyping = event.target === this.#words;
    if (isTyping && event.key === "Escape") {
      this.#words.value = "";
      this.#words.blur();
      this.#show();
    } else if (!isTyping && event.key === "/") {
      event.preventDefault();
      this.#words.focus();
    } else if (!isTyping && event.key === "d") {
      this.#theme.toggle();
    }
  }
}
