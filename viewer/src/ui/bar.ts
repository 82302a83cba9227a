// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { element, setHidden, setText } from "../dom";
import type { View, ViewContext } from "../view";
import { ConnectionPill } from "./connection_pill";
import { makeUndoTare } from "./tare_banner";

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
      element("span", { class: "brand" }, "dermis"),
      makeSuitName(context),
      element("nav", { class: "tabs", "aria-label": "Views" }, ...this.#tabs),
      makeSelector(context),
      element("span", { class: "stretch" }),
      this.#pill.element,
      makeRecord(context, actions),
      makePause(context, actions),
      makeTare(context, actions),
      makeUndoTare(context.stream),
      element(
        "button",
        {
          class: "button",
          "data-role": "show-take",
          title: "Recordings, the last minute, pictures (S)",
          onclick: () => actions.showTake(),
        },
        "Save",
      ),
      element(
        "button",
        { class: "button", "data-role": "show-thresholds", onclick: () => actions.showThresholds() },
        "Thresholds",
      ),
      element(
        "button",
        {
          class: "button icon",
          "data-role": "theme",
          "aria-label": "Light or dark",
          title: "Light or dark (D)",
          onclick: () => context.theme.toggle(),
        },
        "\u25d0",
      ),
      element(
        "button",
        {
          class: "button icon",
          "data-role": "show-help",
          "aria-label": "Keys",
          title: "Keys (?)",
          onclick: () => actions.showHelp(),
        },
        "?",
      ),
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
  const button = element("button", {
    class: "button",
    "data-role": "pause",
    title: "Stop the picture, go on (Space)",
    onclick: () => actions.togglePause(),
  });
  stream.serverInfo.follow((info) => {
    const isPlayback = info?.capabilities.includes("playbackControl") === true;
    if (isPlayback) paused.value = false;
    setHidden(button, isPlayback);
  });
  paused.follow((isPaused) => {
    button.setAttribute("aria-pressed", String(isPaused));
    setText(button, isPaused ? "Paused" : "Pause");
  });
  return button;
}

function makeTare({ stream, suit }: ViewContext, actions: BarActions): HTMLElement {
  const button = element(
    "button",
    { class: "button", "data-role": "tare", title: "What is shown now is zero (T)", onclick: () => actions.tare() },
    "Tare",
  );
  const enable = (): void => {
    const isCalibrated = suit.description.value.arrays.some(({ calibrated }) => calibrated);
    button.disabled = !isCalibrated || typeof stream.parameters.value.get("/tare") !== "boolean";
    button.title = isCalibrated ? "What is shown now is zero (T)" : "Counts have no zero: calibrate first";
  };
  suit.description.follow(enable);
  stream.parameters.follow((parameters) => {
    enable();
    const isOn = parameters.get("/tare") === true;
    button.setAttribute("aria-pressed", String(isOn));
    setText(button, isOn ? "Tared" : "Tare");
  });
  return button;
}
