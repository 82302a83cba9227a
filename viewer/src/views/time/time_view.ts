// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import "uplot/dist/uPlot.min.css";
import { button, element, setHidden, setText } from "../../dom";
import { errorText, fixed } from "../../format";
import { SLOTS } from "../../live/contact_slots";
import { EVENT_KINDS } from "../../live/event_log";
import { binOf } from "../../live/force_history";
import { regionName } from "../../live/region_force";
import { setting } from "../../settings";
import type { View, ViewContext, ViewFactory } from "../../view";
import { EVENT_LOOKS } from "./event_marks";
import { ForcePlot, type Line } from "./force_plot";
import { ReadingHistories } from "./reading_histories";
import "./time.css";

const WINDOWS_S = [10, 60];
const PERIOD_MS = 45;
const CONTACTS_TITLE = "Force of each contact of the array";
/** More arrays than colours: the one that is chosen is shown alone. */
const MOST_LINES = 8;

class TimeView implements View {
  readonly name = "time";
  readonly title = "Time";
  readonly element: HTMLElement;
  readonly #context: ViewContext;
  readonly #totals = new ForcePlot("Total force of each array", "plot-totals");
  readonly #contacts = new ForcePlot(CONTACTS_TITLE, "plot-contacts");
  readonly #readings: ReadingHistories;
  readonly #windowS = setting<number>("window", 10, (value) => WINDOWS_S.includes(value));
  readonly #label = element("input", {
    class: "field compact",
    placeholder: "label",
    "aria-label": "Label of the mark",
    maxlength: 60,
    "data-role": "mark-label",
  });
  readonly #lastEvent = element("p", { class: "dim", "data-role": "last-event" });
  #isShown = false;
  #linesDue = true;
  #version = -1;
  #drawnMs = 0;

  constructor(context: ViewContext) {
    this.#context = context;
    this.#readings = new ReadingHistories(context.stream);
    this.element = element(
      "div",
      { class: "view time-view", "data-view": "time" },
      this.#makeToolbar(),
      this.#totals.element,
      this.#contacts.element,
    );
    const changed = (): void => {
      this.#linesDue = true;
    };
    context.theme.shown.follow(changed);
    context.suit.selected.follow(changed);
    context.suit.description.follow(changed);
    context.live.region.region.follow(changed);
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
    this.#readings.follow([]);
  }

  draw(nowMs: number): void {
    const { live } = this.#context;
    const isNew = live.version !== this.#version && nowMs - this.#drawnMs >= PERIOD_MS;
    if (!this.#isShown || (!isNew && !this.#linesDue)) return;
    if (this.#linesDue) this.#setLines();
    this.#version = live.version;
    this.#drawnMs = nowMs;
    const endBin = binOf(live.latestS);
    const chosen = this.#context.suit.selected.value?.name;
    const events = [...live.events.events, ...live.events.marks].filter(
      ({ array, atS }) => atS <= live.latestS && (array === "" || array === chosen),
    );
    events.sort((a, b) => a.atS - b.atS);
    this.#totals.draw(endBin, events);
    this.#contacts.draw(endBin, events);
    const last = events.at(-1);
    setText(
      this.#lastEvent,
      last === undefined ? "" : `last: ${last.words}, ${fixed(live.latestS - last.atS, 1)} s ago`,
    );
  }

  /** At the moment that is shown. */
  #mark(): void {
    const { live } = this.#context;
    live.marks.add(live.latestS, this.#label.value.trim() || undefined).catch((error) => {
      setText(this.#lastEvent, errorText(error));
    });
    this.#linesDue = true;
  }

  #makeToolbar(): HTMLElement {
    const choice = (seconds: number): HTMLElement => {
      const radio = element("input", {
        type: "radio",
        name: "window",
        value: seconds,
        onchange: () => (this.#windowS.value = seconds),
      });
      this.#windowS.follow((value) => (radio.checked = value === seconds));
      return element("label", { class: "check" }, radio, `${seconds} s`);
    };
    const kinds = EVENT_KINDS.map((kind) =>
      element(
        "span",
        { class: "group" },
        element("span", { class: "event-swatch", style: `background: var(${EVENT_LOOKS[kind].color})` }),
        EVENT_LOOKS[kind].words,
      ),
    );
    return element(
      "div",
      { class: "toolbar" },
      element(
        "fieldset",
        { class: "group" },
        element("legend", { class: "only-spoken" }, "Window"),
        ...WINDOWS_S.map(choice),
      ),
      this.#label,
      button("Mark this moment", () => this.#mark(), {
        class: "compact",
        "data-role": "mark",
        title: "A line at this moment (M)",
      }),
      this.#lastEvent,
      element("p", { class: "marks dim" }, ...kinds),
    );
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
    const withForces = arrays.filter(({ calibrated }) => calibrated);
    const shown = withForces.length > MOST_LINES ? withForces.filter(({ name }) => name === chosen) : withForces;
    setHidden(this.#totals.element, withForces.length === 0);
    const { region, history } = live.region;
    const drawn = region.value;
    const ofRegion: Line[] =
      drawn === undefined ? [] : [{ name: () => `region ${regionName(drawn)}`, color: "--text", history }];
    this.#totals.setLines([...shown.map(({ name }, index) => line(name, index)), ...ofRegion], this.#windowS.value);
    const isCalibrated = suit.selected.value?.calibrated !== false;
    this.#readings.follow(isCalibrated ? [] : [chosen]);
    if (isCalibrated) this.#setContacts(chosen);
    else this.#setReadings(chosen);
  }

  /** There are counts alone. */
  #setReadings(array: string): void {
    this.#contacts.setTitle("Highest reading of the array, which is not calibrated yet", "counts");
    this.#contacts.setLines(
      [{ name: () => array, color: "--series-1", history: this.#readings.of(array) }],
      this.#windowS.value,
    );
  }

  #setContacts(chosen: string): void {
    const { live, suit } = this.#context;
    this.#contacts.setTitle(CONTACTS_TITLE, "N");
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
