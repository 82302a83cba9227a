// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { button, element, setHidden, setText } from "../dom";
import type { View, ViewContext } from "../view";
import { ConnectionPill } from "./connection_pill";
import { makeUndoTare } from "./tare_banner";
import "./bar.css";

const ACTIONS = "bar-actions";

export interface BarActions {
  toggleRecording(): void;
  togglePause(): void;
  tare(): void;
  showTake(): void;
  showThresholds(): void;
  showHelp(): void;
}

/** The line above every view. */
export class Bar {
  readonly element: HTMLElement;
  readonly #pill: ConnectionPill;
  readonly #tabs: HTMLElement[];

  constructor(context: ViewContext, views: readonly View[], actions: BarActions) {
    this.#pill = new ConnectionPill(context);
    this.#tabs = views.map(({ name, title }) =>
      element(
        "a",
        { class: "tab", href: `#/${name}`, "data-tab": name, onclick: (event) => this.#go(event, context, name) },
        title,
      ),
    );
    this.element = element(
      "header",
      { class: "bar" },
      element("h1", { class: "brand" }, "dermis"),
      makeSuitName(context),
      element("nav", { class: "tabs", "aria-label": "Views" }, ...this.#tabs),
      makeSelector(context),
      element("span", { class: "stretch" }),
      this.#pill.element,
      element(
        "button",
        { class: "button icon bar-menu", popovertarget: ACTIONS, "aria-label": "More", "data-role": "more" },
        "\u22ef",
      ),
      makeActions(context, actions),
    );
  }

  showTab(name: string): void {
    for (const tab of this.#tabs) {
      if (tab.dataset.tab === name) tab.setAttribute("aria-current", "page");
      else tab.removeAttribute("aria-current");
    }
  }

  draw(nowMs: number): void {
    this.#pill.draw(nowMs);
  }

  #go(event: Event, context: ViewContext, name: string): void {
    event.preventDefault();
    context.open(name);
  }
}

/** A menu where the page is narrow. */
function makeActions(context: ViewContext, actions: BarActions): HTMLElement {
  return element(
    "div",
    { id: ACTIONS, class: "bar-actions", popover: "auto" },
    makeRecord(context, actions),
    makePause(context, actions),
    makeTare(context, actions),
    makeUndoTare(context.stream),
    button("Save", () => actions.showTake(), {
      "data-role": "show-take",
      title: "Recordings, the last minute, pictures (S)",
    }),
    button("Thresholds", () => actions.showThresholds(), { "data-role": "show-thresholds" }),
    button("\u25d0", () => context.theme.toggle(), {
      class: "icon",
      "data-role": "theme",
      "aria-label": "Light or dark",
      title: "Light or dark (D)",
    }),
    button("?", () => actions.showHelp(), {
      class: "icon",
      "data-role": "show-help",
      "aria-label": "Keys",
      title: "Keys (?)",
    }),
  );
}

function makeSuitName({ suit }: ViewContext): HTMLElement {
  const name = element("span", { class: "suit-name dim", "data-role": "suit-name" });
  suit.description.follow((description) => setText(name, description.name));
  return name;
}

function makeSelector(context: ViewContext): HTMLElement {
  const { suit } = context;
  const select = element("select", {
    class: "field",
    "aria-label": "Array",
    "data-role": "array",
    onchange: () => suit.select(select.value),
  });
  suit.description.follow(({ arrays }) => {
    select.replaceChildren(
      ...arrays.map(({ name, rows, cols }) => element("option", { value: name }, `${name}  ${rows}\u00d7${cols}`)),
    );
    select.value = suit.selected.value?.name ?? "";
    setHidden(select, arrays.length === 0);
  });
  suit.selected.follow((array) => (select.value = array?.name ?? ""));
  return select;
}

function makeRecord({ stream, live }: ViewContext, actions: BarActions): HTMLElement {
  const file = element("span", { class: "file dim", "data-role": "recording-file" });
  const words = element("span", {}, "Record");
  const button = element(
    "button",
    {
      class: "button record",
      "data-role": "record",
      "aria-pressed": "false",
      title: "Begin or end a recording (R)",
      onclick: () => actions.toggleRecording(),
    },
    element("span", { class: "record-dot" }),
    words,
  );
  stream.parameters.follow((parameters) => {
    const isOn = parameters.get("/recording") === true;
    button.disabled = typeof parameters.get("/recording") !== "boolean";
    button.setAttribute("aria-pressed", String(isOn));
    setText(words, isOn ? "Recording" : "Record");
  });
  live.statistics.follow((statistics) => {
    const path = statistics?.recording === true ? statistics.recordingFile : "";
    setText(file, path.split("/").at(-1) ?? "");
    file.title = path;
  });
  return element("span", { class: "record-group" }, button, file);
}

function makePause({ paused, stream }: ViewContext, actions: BarActions): HTMLElement {
  const pause = button("", () => actions.togglePause(), {
    "data-role": "pause",
    title: "Stop the picture, go on (Space)",
  });
  stream.serverInfo.follow((info) => {
    const isPlayback = info?.capabilities.includes("playbackControl") === true;
    if (isPlayback) paused.value = false;
    setHidden(pause, isPlayback);
  });
  paused.follow((isPaused) => {
    pause.setAttribute("aria-pressed", String(isPaused));
    setText(pause, isPaused ? "Paused" : "Pause");
  });
  return pause;
}

function makeTare({ stream, suit }: ViewContext, actions: BarActions): HTMLElement {
  const tare = button("Tare", () => actions.tare(), { "data-role": "tare", title: "What is shown now is zero (T)" });
  const enable = (): void => {
    const isCalibrated = suit.description.value.arrays.some(({ calibrated }) => calibrated);
    tare.disabled = !isCalibrated || typeof stream.parameters.value.get("/tare") !== "boolean";
    tare.title = isCalibrated ? "What is shown now is zero (T)" : "Counts have no zero: calibrate first";
  };
  suit.description.follow(enable);
  stream.parameters.follow((parameters) => {
    enable();
    const isTaken = parameters.get("/tare/taken") === true;
    tare.setAttribute("aria-pressed", String(isTaken));
    setText(tare, isTaken ? "Tared" : parameters.get("/tare") === true ? "Taring \u2026" : "Tare");
  });
  return tare;
}
