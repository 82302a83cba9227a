// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import "uplot/dist/uPlot.min.css";
import { element } from "../../dom";
import { SLOTS } from "../../live/contact_slots";
import { binOf } from "../../live/force_history";
import { setting } from "../../settings";
import type { View, ViewContext, ViewFactory } from "../../view";
import { ForcePlot, type Line } from "./force_plot";

const WINDOWS_S = [10, 60];
const PERIOD_MS = 45;
/** More arrays than colours: the one that is chosen is shown alone. */
const MOST_LINES = 8;

class TimeView implements View {
  readonly name = "time";
  readonly title = "Time";
  readonly element: HTMLElement;
  readonly #context: ViewContext;
  readonly #totals = new ForcePlot("Total force of each array", "plot-totals");
  readonly #contacts = new ForcePlot("Force of each contact of the array", "plot-contacts");
  readonly #windowS = setting<number>("window", 10, (value) => WINDOWS_S.includes(value));
  #isShown = false;
  #linesDue = true;
  #version = -1;
  #drawnMs = 0;

  constructor(context: ViewContext) {
    this.#context = context;
    this.element = element(
      "div",
      { class: "view time-view", "data-view": "time" },
      this.#makeToolbar(),
      this.#totals.element,
      this.#contacts.element,
    );
    const changed = (): void => void (this.#linesDue = true);
    context.theme.shown.follow(changed);
    context.suit.selected.follow(changed);
    context.suit.description.follow(changed);
    this.#windowS.follow(changed);
  }

  show(): void {
    this.#isShown = true;
    this.#linesDue = true;
    this.#totals.show();
    this.#contacts.show();
  }

  hide(): void {
    this.#isShown = false;
    this.#totals.hide();
    this.#contacts.hide();
  }

  draw(nowMs: number): void {
    const { live } = this.#context;
    const isNew = live.version !== this.#version && nowMs - this.#drawnMs >= PERIOD_MS;
    if (!this.#isShown || (!isNew && !this.#linesDue)) return;
    if (this.#linesDue) this.#setLines();
    this.#version = live.version;
    this.#drawnMs = nowMs;
    const endBin = binOf(live.latestS);
    this.#totals.draw(endBin);
    this.#contacts.draw(endBin);
  }

  #makeToolbar(): HTMLElement {
    const choice = (seconds: number): HTMLElement => {
      const radio = element("input", { type: "radio", name: "window", value: seconds, onchange: () => (this.#windowS.value = seconds) });
      this.#windowS.follow((value) => (radio.checked = value === seconds));
      return element("label", { class: "check" }, radio, `${seconds} s`);
    };
    return element("fieldset", { class: "toolbar" }, element("legend", { class: "only-spoken" }, "Window"), ...WINDOWS_S.map(choice));
  }

  #setLines(): void {
    this.#linesDue = false;
    const { live, suit } = this.#context;
    const { arrays } = suit.description.value;
    const chosen = suit.selected.value?.name ?? "";
    const line = (name: string, color: number): Line => ({
      name: () => name,
      color: `--series-${color + 1}`,
      history: live.arrays[suit.indexOf(name)]!.total,
    });
    const shown = arrays.length > MOST_LINES ? arrays.filter(({ name }) => name === chosen) : arrays;
    this.#totals.setLines(shown.map(({ name }, index) => line(name, index)), this.#windowS.value);
    const slots = live.arrays[suit.indexOf(chosen)]?.slots.slots ?? [];
    const contacts = slots.slice(0, SLOTS).map((slot, index) => ({
      name: () => (slot.id === 0 ? "ended" : `contact ${slot.id}`),
      color: `--series-${index + 1}`,
      history: slot.history,
    }));
    this.#contacts.setLines(contacts, this.#windowS.value);
  }
}

export const createTimeView: ViewFactory = (context) => new TimeView(context);
