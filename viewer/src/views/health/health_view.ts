// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { element, panel, setData, setText, table } from "../../dom";
import { count, fixed } from "../../format";
import { KeyedRows, type Row } from "../../keyed_rows";
import { type ArrayStatistics, DiagnosticLevel, type HealthStatus, type Statistics } from "../../messages/statistics";
import type { View, ViewContext, ViewFactory } from "../../view";
import "./health.css";

const HEADS = [
  "Array",
  "State",
  "Rate",
  "Jitter",
  "Frames",
  "Lost",
  "Damaged",
  "Rejected",
  "Skipped",
  "Latency p50",
  "p99",
  "Temperature",
  "Supply",
];
const { ok, warn, error, stale } = DiagnosticLevel;
const LEVELS: Record<number, string> = { [ok]: "good", [warn]: "warn", [error]: "bad", [stale]: "warn" };
const LEVEL_WORDS: Record<number, string> = { [ok]: "well", [warn]: "warning", [error]: "error", [stale]: "no news" };
const PERIOD_MS = 500;

/** In one unit, so that rows can be compared; 0 is what nobody has measured. */
function time(seconds: number): string {
  return known(seconds === 0 ? NaN : 1e3 * seconds, 2, "ms");
}

function known(value: number, digits: number, unit: string): string {
  return Number.isNaN(value) ? fixed(value, 0) : `${fixed(value, digits)} ${unit}`;
}

class ArrayRow implements Row<ArrayStatistics> {
  readonly element: HTMLTableRowElement;
  readonly #cells = HEADS.slice(1).map((head) =>
    element("td", { class: head === "State" ? "" : "figure", "data-field": head.toLowerCase() }),
  );

  constructor(name: string, open: () => void) {
    const link = element("button", { class: "link", onclick: open, title: "Show its maps" }, name);
    this.element = element("tr", { "data-array": name }, element("th", { scope: "row" }, link), ...this.#cells);
  }

  show(array: ArrayStatistics): void {
    const state = array.error !== "" ? array.error : array.ended ? "ended" : "live";
    setData(this.#cells[0]!, "level", array.error !== "" ? "bad" : array.ended ? "warn" : "good");
    const texts = [
      state,
      known(array.rateHz, 1, "Hz"),
      time(array.jitterS),
      count(array.frames),
      count(array.lost),
      count(array.damaged),
      count(array.rejected),
      count(array.skipped),
      time(array.latencyP50S),
      time(array.latencyP99S),
      known(array.temperatureCelsius, 1, "\u00b0C"),
      known(array.supplyV, 3, "V"),
    ];
    this.#cells.forEach((cell, index) => setText(cell, texts[index]!));
    [4, 5, 6, 7].forEach((column) =>
      this.#cells[column]!.classList.toggle("attention", this.#cells[column]!.textContent !== "0"),
    );
  }
}

function recordingWords(server: Statistics | undefined): string {
  if (server === undefined || !server.recording) return "off";
  const leftOut =
    server.recordingLeftOut > 0 ? `, ${count(server.recordingLeftOut)} left out: the disk does not follow` : "";
  return `${server.recordingFile}, ${count(server.recordingFrames)} frames${leftOut}`;
}

class HealthView implements View {
  readonly name = "health";
  readonly title = "Health";
  readonly element: HTMLElement;
  readonly #context: ViewContext;
  readonly #body = element("tbody");
  readonly #rows = new KeyedRows<ArrayStatistics>(
    this.#body,
    ({ name }) => name,
    ({ name }) => new ArrayRow(name, () => this.#context.open("array", name)),
  );
  readonly #faults = element("ul", { class: "faults", "data-role": "faults" });
  readonly #figures = element("dl", { class: "pairs", "data-role": "page-figures" });
  readonly #unfollow: (() => void)[] = [];
  #seen = { ms: 0, pictures: 0, messages: 0, bytes: 0 };

  constructor(context: ViewContext) {
    this.#context = context;
    this.element = element(
      "div",
      { class: "view health-view", "data-view": "health" },
      panel("Arrays", {}, table(HEADS, "health-table", this.#body)),
      element(
        "div",
        { class: "columns" },
        panel("Faults", {}, this.#faults),
        panel("Stream and page", {}, this.#figures),
      ),
    );
  }

  show(): void {
    const { live } = this.#context;
    this.#seen.ms = 0;
    this.#unfollow.push(
      live.statistics.follow((statistics) => this.#showArrays(statistics)),
      live.health.follow((health) => this.#showFaults(health)),
    );
  }

  hide(): void {
    for (const end of this.#unfollow.splice(0)) end();
  }

  draw(nowMs: number): void {
    if (nowMs - this.#seen.ms < PERIOD_MS) return;
    const { stream, display, live } = this.#context;
    const seconds = (nowMs - this.#seen.ms) / 1000;
    const rate = (now: number, before: number): number => (this.#seen.ms === 0 ? NaN : (now - before) / seconds);
    const server = live.statistics.value;
    const pairs: [string, string][] = [
      ["Time of frame to screen, p50", known(1e3 * display.latency(0.5), 1, "ms")],
      ["p99", known(1e3 * display.latency(0.99), 1, "ms")],
      ["Pictures of this page", known(rate(display.pictures, this.#seen.pictures), 0, "a second")],
      ["Messages", known(rate(stream.messages, this.#seen.messages), 0, "a second")],
      ["Received", known(rate(stream.bytes, this.#seen.bytes) / 1024, 1, "KiB/s")],
      ["Connections lost", count(Math.max(0, stream.reconnects))],
      ["Clients of the server", server === undefined ? fixed(NaN, 0) : count(server.clients)],
      ["Messages slow clients missed", server === undefined ? fixed(NaN, 0) : count(server.clientDrops)],
      ["Frames not streamed for want of time", server === undefined ? fixed(NaN, 0) : count(server.framesNotStreamed)],
      ["Recording", recordingWords(server)],
    ];
    this.#showPairs(pairs);
    this.#seen = { ms: nowMs, pictures: display.pictures, messages: stream.messages, bytes: stream.bytes };
  }

  #showPairs(pairs: [string, string][]): void {
    if (this.#figures.childElementCount === 0) {
      this.#figures.append(
        ...pairs.flatMap(([name]) => [
          element("dt", {}, name),
          element("dd", { class: "figure", "data-figure": name }),
        ]),
      );
    }
    pairs.forEach(([, text], index) => setText(this.#figures.children[2 * index + 1] as HTMLElement, text));
  }

  #showArrays(statistics: Statistics | undefined): void {
    if (statistics !== undefined) this.#rows.show(statistics.arrays);
  }

  #showFaults(health: readonly HealthStatus[]): void {
    this.#faults.replaceChildren(
      ...health.map(({ level, name, message, values }) =>
        element(
          "li",
          { "data-array": name },
          element(
            "span",
            { class: "pill", "data-level": LEVELS[level] ?? "warn" },
            LEVEL_WORDS[level] ?? String(level),
          ),
          element("strong", {}, name),
          element("span", {}, message),
          element(
            "ul",
            {},
            ...values.map(({ key, value }) => element("li", {}, element("span", { class: "dim" }, key), value)),
          ),
        ),
      ),
    );
  }
}

export const createHealthView: ViewFactory = (context) => new HealthView(context);
