// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { element, setData, setHidden, setText } from "../dom";
import { count, dayAndTime, fixed } from "../format";
import { KeyedRows, type Row } from "../keyed_rows";
import {
  type ArrayState,
  LEVELS,
  modelOf,
  type Robot,
  recordCommand,
  type SortKey,
  type StateName,
  span,
  stateOfArray,
  wayTo,
} from "./fleet_data";

export const COLUMNS: readonly { readonly key?: SortKey; readonly name: string; readonly title: string }[] = [
  { key: "state", name: "State", title: "The worst of its arrays, or silence" },
  { key: "robot", name: "Robot", title: "Its name, with the way to its own page" },
  { key: "arrays", name: "Arrays", title: "Its arrays" },
  { key: "rate", name: "Rate", title: "Frames a second, of all its arrays" },
  { key: "lost", name: "Lost", title: "Frames that the arrays lost, and those that were not published" },
  { key: "lag", name: "Lag", title: "Age of its newest message on the hub, and messages that are still to come" },
  { key: "faults", name: "Faults", title: "Taxels that are dead or on faulty lines" },
  { key: "drift", name: "Drift", title: "Change of the gains from taxel to taxel since the calibration" },
  { key: "calibration", name: "Calibration", title: "Arrays that ask to be calibrated" },
  { name: "Remarks", title: "Why, and what it says of its arrays" },
];

function known(value: number, digits: number, unit: string): string {
  return Number.isNaN(value) ? fixed(value, 0) : `${fixed(value, digits)} ${unit}`;
}

function lostWords(lost: number, leftOut: number): string {
  return leftOut > 0 ? `${count(lost)} + ${count(leftOut)}` : count(lost);
}

/** A state by its colour and its word. */
function statePill(): { element: HTMLElement; show: (word: StateName) => void } {
  const word = element("span");
  const pill = element("span", { class: "pill" }, element("span", { class: "lamp" }), word);
  return {
    element: pill,
    show: (state) => {
      setData(pill, "level", LEVELS[state]);
      setText(word, state);
    },
  };
}

/** Cells under the columns from `Arrays` on. */
function figureCells(): HTMLTableCellElement[] {
  return COLUMNS.slice(2).map(({ name }) =>
    element("td", {
      role: "cell",
      class: name === "Remarks" || name === "Calibration" ? "words" : "figure",
      "data-field": name.toLowerCase(),
      "data-head": name,
    }),
  );
}

function showCells(cells: readonly HTMLElement[], texts: readonly string[], marked: readonly boolean[]): void {
  cells.forEach((cell, index) => {
    setText(cell, texts[index]!);
    cell.classList.toggle("attention", marked[index] ?? false);
    cell.classList.toggle("nothing", texts[index] === "");
  });
}

interface ArrayOfRobot {
  readonly index: number;
  readonly array: ArrayState;
  readonly isSilent: boolean;
  readonly isStale: boolean;
}

class ArrayRow implements Row<ArrayOfRobot> {
  readonly element: HTMLTableRowElement;
  readonly #pill = statePill();
  readonly #name = element("span", { class: "told" });
  readonly #cells = figureCells();

  constructor() {
    setData(this.#cells[0]!, "head", "Size");
    this.element = element(
      "tr",
      { role: "row", class: "array-row" },
      element("td", { role: "cell", class: "state" }, this.#pill.element),
      element("th", { role: "rowheader", scope: "row" }, this.#name),
      ...this.#cells,
    );
  }

  show({ array, isSilent, isStale }: ArrayOfRobot): void {
    this.#pill.show(isSilent ? "silent" : stateOfArray(array));
    setText(this.#name, array.name);
    const texts = [
      `${count(array.rows)} \u00d7 ${count(array.cols)}`,
      known(isSilent || isStale ? NaN : array.rate_hz, 1, "Hz"),
      lostWords(array.lost, array.left_out),
      "",
      count(array.masked_taxels),
      known(100 * (array.gain_change ?? NaN), 0, "%"),
      array.wants_calibration ? "calibrate" : modelOf(array),
      array.refusal === "" ? array.message : array.refusal,
    ];
    const marks = [false, false, array.lost + array.left_out > 0, false, array.masked_taxels > 0, false];
    showCells(this.#cells, texts, [...marks, array.wants_calibration || array.refusal !== ""]);
  }
}

/** The command that gets the frames of an array, which the hub has also while the robot is off or cannot be reached. */
class RecordRow implements Row<string> {
  readonly #command = element("code");
  readonly element = element(
    "tr",
    { role: "row", class: "record-row" },
    element(
      "td",
      { role: "cell", class: "words", colspan: String(COLUMNS.length), "data-head": "Recording" },
      this.#command,
    ),
  );

  show(command: string): void {
    setText(this.#command, command);
  }
}

/** A robot, and on demand its arrays: one body of the table. */
export class RobotRow implements Row<Robot> {
  readonly element = element("tbody", { role: "rowgroup" });
  readonly #pill = statePill();
  readonly #told = element("span", { class: "dim", "data-role": "since" });
  readonly #toggle: HTMLButtonElement;
  readonly #name = element("span", { class: "robot-name told" });
  readonly #cells = figureCells();
  readonly #hub: () => string;
  readonly #arrays: KeyedRows<ArrayOfRobot | string>;
  #live: string | undefined;
  #shown: Robot | undefined;
  #isOpen = false;

  /** `hub`: its address, for commands. */
  constructor(hub: () => string) {
    this.#hub = hub;
    this.#toggle = element("button", {
      type: "button",
      class: "unfold",
      "aria-expanded": "false",
      onclick: () => this.#setOpen(!this.#isOpen),
    });
    const head = element("th", { role: "rowheader", scope: "row" }, this.#toggle, this.#name);
    const state = element("td", { role: "cell", class: "state" }, this.#pill.element, this.#told);
    this.element.append(element("tr", { role: "row", class: "robot-row" }, state, head, ...this.#cells));
    this.#arrays = new KeyedRows(
      this.element,
      (item) => (typeof item === "string" ? item : String(item.index)),
      (item): Row<ArrayOfRobot | string> => (typeof item === "string" ? new RecordRow() : new ArrayRow()),
    );
  }

  show(robot: Robot): void {
    this.#shown = robot;
    const { state, word } = robot;
    setData(this.element, "robot", state.name);
    setData(this.element, "state", word);
    this.#pill.show(word);
    const isKnown = word !== "well" && state.since_s !== null;
    setText(this.#told, isKnown ? span(state.since_s) : "");
    this.#told.title = isKnown ? `Since ${dayAndTime(Date.now() / 1000 - state.since_s)}` : "";
    this.#showName(state.name, state.live);
    const texts = [
      count(state.arrays.length),
      state.arrays.length === 0 ? fixed(NaN, 0) : known(robot.rateHz, 1, "Hz"),
      lostWords(robot.lost, robot.leftOut),
      `${span(state.age_s)}${state.lag > 0 ? `, ${count(state.lag)} behind` : ""}`,
      count(robot.masked),
      known(100 * robot.drift, 0, "%"),
      robot.toCalibrate.join(", "),
      robot.remarks,
    ];
    const marks = [false, false, robot.lost + robot.leftOut > 0, state.lag > 0, robot.masked > 0, false];
    showCells(this.#cells, texts, [...marks, robot.toCalibrate.length > 0]);
    setHidden(this.#toggle, state.arrays.length === 0);
    this.#showArrays(robot);
  }

  #showName(name: string, live: string): void {
    if (this.#live === live) return;
    this.#live = live;
    const { url, reason } = wayTo(live, window.location.hostname);
    this.#toggle.setAttribute("aria-label", `Arrays of ${name}`);
    this.#name.replaceChildren(
      url === undefined
        ? name
        : element("a", { href: url, target: "_blank", rel: "noopener noreferrer", title: `Open ${url}` }, name),
    );
    this.#name.title = reason ?? "";
  }

  #setOpen(isOpen: boolean): void {
    this.#isOpen = isOpen;
    this.#toggle.setAttribute("aria-expanded", String(isOpen));
    if (this.#shown !== undefined) this.#showArrays(this.#shown);
  }

  #showArrays(robot: Robot): void {
    const arrays = this.#isOpen ? robot.state.arrays : [];
    const { name, silent, stale } = robot.state;
    this.#arrays.show(
      arrays.flatMap((array, index) => [
        { index, array, isSilent: silent, isStale: stale },
        recordCommand(this.#hub(), name, array.name),
      ]),
    );
  }
}
