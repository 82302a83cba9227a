// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { element, setData, setHidden, setText } from "../../dom";
import { fixed, statusWord } from "../../format";
import { emptyGrid, type GridFrame, readCounts, readGrid } from "../../messages/grids";
import { type Area, HeatMaps } from "../../render/heat_maps";
import { setting } from "../../settings";
import type { Signal } from "../../signal";
import type { ArrayDescription } from "../../suit";
import { rgbColor } from "../../theme";
import type { View, ViewContext, ViewFactory } from "../../view";
import { drawAxes } from "./axes";
import { ContactTable } from "./contact_table";
import { fitMap, taxelAt, taxelName } from "./geometry";
import { MapPanel } from "./map_panel";
import { Overlay } from "./overlay";
import { QUANTITIES } from "./quantities";
import { Summary } from "./summary";
import { MOST_PINS, TaxelTable } from "./taxel_table";
import { drawZones } from "./zones";

const TEXT_PERIOD_MS = 100;
const RAW = 0;
const FORCE = 2;
const NOWHERE: Area = { left: 0, top: 0, width: 0, height: 0 };

/** What arrives of one quantity: the newest message, decoded when it is drawn. */
interface Feed {
  readonly frame: GridFrame;
  message: DataView | undefined;
  end: () => void;
}

class ArrayView implements View {
  readonly name = "array";
  readonly title = "Array";
  readonly element: HTMLElement;
  readonly #context: ViewContext;
  readonly #panels = QUANTITIES.map((quantity) => new MapPanel(quantity));
  readonly #feeds: Feed[] = QUANTITIES.map(() => ({ frame: emptyGrid(), message: undefined, end: () => undefined }));
  readonly #maps: HeatMaps;
  readonly #overlay = new Overlay(element("canvas", { class: "layer", "aria-hidden": "true" }));
  readonly #axes = element("canvas", { class: "layer", "aria-hidden": "true" });
  readonly #zones = element("div", { class: "layer zones", "aria-hidden": "true" });
  readonly #room: HTMLElement;
  readonly #spoken = element("p", { class: "only-spoken", "aria-live": "polite" });
  readonly #taxels = new TaxelTable();
  readonly #contacts = new ContactTable();
  readonly #summary = new Summary();
  readonly #interpolated = setting<boolean>("interpolated", false, () => true);
  /** The one that a narrow page shows. */
  readonly #chosenMap = setting<number>("map", FORCE, (value) => value in QUANTITIES);
  readonly #narrow = window.matchMedia("(max-width: 700px)");
  readonly #uncalibrated: HTMLElement;
  readonly #contactsShown = setting<boolean>("contacts", true, () => true);
  readonly #resizing = new ResizeObserver(() => (this.#layoutDue = true));
  readonly #unfollow: (() => void)[] = [];
  #isShown = false;
  #array: ArrayDescription | undefined;
  #areas: Area[] = [];
  #pins: number[] = [];
  #cursor = -1;
  #layoutDue = true;
  #mapsDue = true;
  #overlayDue = true;
  #textDue = true;
  #contactsVersion = -1;
  #textMs = 0;

  constructor(context: ViewContext) {
    this.#context = context;
    this.#maps = new HeatMaps(element("canvas", { class: "layer", "aria-hidden": "true" }), QUANTITIES.length, () => this.#restore());
    this.#uncalibrated = this.#makeUncalibrated();
    this.#room = this.#makeRoom();
    this.element = element(
      "div",
      { class: "view array-view", "data-view": "array" },
      this.#makeToolbar(),
      this.#room,
      element("div", { class: "readouts" }, this.#taxels.element, this.#contacts.element, this.#summary.element),
      this.#spoken,
    );
    context.theme.shown.follow(() => this.#readColors());
    this.#narrow.addEventListener("change", () => (this.#layoutDue = true));
    context.suit.selected.follow((array) => this.#choose(array));
    for (const panel of this.#panels) panel.end.follow(() => this.#describe());
  }

  show(): void {
    this.#isShown = true;
    this.#follow();
    this.#resizing.observe(this.#room);
    this.#layoutDue = true;
  }

  hide(): void {
    this.#isShown = false;
    for (const end of this.#unfollow.splice(0)) end();
    this.#resizing.disconnect();
  }

  draw(nowMs: number): void {
    const array = this.#array;
    if (array === undefined) return;
    if (this.#layoutDue) this.#layOut(array);
    if (!this.#context.paused.value) this.#decode(array);
    if (this.#mapsDue) {
      this.#maps.draw();
      this.#mapsDue = false;
    }
    this.#drawContacts(array);
    if (this.#textDue && nowMs - this.#textMs >= TEXT_PERIOD_MS) this.#showText(array, nowMs);
  }

  key(event: KeyboardEvent): boolean {
    if (event.key === "i") this.#interpolated.value = !this.#interpolated.value;
    else if (event.key === "c") this.#contactsShown.value = !this.#contactsShown.value;
    else return false;
    return true;
  }

  #makeToolbar(): HTMLElement {
    const check = (label: string, signal: Signal<boolean>, role: string): HTMLElement => {
      const box = element("input", { type: "checkbox", "data-role": role, onchange: () => (signal.value = box.checked) });
      signal.follow((value) => (box.checked = value));
      return element("label", { class: "check" }, box, label);
    };
    this.#interpolated.follow((value) => {
      this.#maps.interpolated = value;
      this.#mapsDue = true;
    });
    this.#contactsShown.follow((value) => {
      this.#overlay.showContacts = value;
      this.#overlayDue = true;
    });
    const chosen = element(
      "select",
      { class: "field map-choice", "aria-label": "Map", "data-role": "map", onchange: () => (this.#chosenMap.value = Number(chosen.value)) },
      ...QUANTITIES.map(({ title }, index) => element("option", { value: index }, title)),
    );
    this.#chosenMap.follow((value) => {
      chosen.value = String(value);
      this.#layoutDue = true;
    });
    return element(
      "div",
      { class: "toolbar" },
      chosen,
      check("Interpolate between taxels", this.#interpolated, "interpolate"),
      check("Contacts", this.#contactsShown, "show-contacts"),
      element(
        "p",
        { class: "marks dim" },
        element("span", { class: "mark-fault" }),
        "faulty taxel",
        element("span", { class: "mark-saturated" }),
        "saturated or above range",
      ),
    );
  }

  #makeUncalibrated(): HTMLElement {
    return element(
      "section",
      { class: "panel uncalibrated", "aria-label": "Not calibrated yet", "data-role": "uncalibrated", hidden: true },
      element("h2", {}, "Not calibrated yet"),
      element("p", {}, "The counts are live. Newtons come with a calibration: known weights on single taxels, as the page asks for them."),
      element("button", { class: "button primary large-button", "data-role": "calibrate", onclick: () => this.#context.open("calibration") }, "Calibrate"),
    );
  }

  #isShownMap(index: number, { calibrated }: ArrayDescription): boolean {
    if (!calibrated) return index === RAW;
    return !this.#narrow.matches || index === this.#chosenMap.value;
  }

  #makeRoom(): HTMLElement {
    const room = element(
      "div",
      {
        class: "maps",
        tabindex: 0,
        role: "application",
        "aria-label": "Maps of the array. Arrow keys move the cursor, Enter pins the taxel, Escape takes the cursor away.",
        "data-role": "maps",
      },
      ...this.#panels.map((panel) => panel.element),
      this.#uncalibrated,
      this.#maps.canvas,
      this.#axes,
      this.#zones,
      this.#overlay.canvas,
    );
    room.addEventListener("pointermove", (event) => this.#point(event));
    room.addEventListener("pointerleave", () => this.#moveCursor(-1));
    room.addEventListener("click", (event) => {
      if (event.target instanceof Element && event.target.closest("select, button") === null) this.#pin(this.#taxelUnder(event));
    });
    room.addEventListener("keydown", (event) => this.#steer(event));
    return room;
  }

  #readColors(): void {
    this.#maps.setColors({
      line: rgbColor("--map-line"),
      fault: rgbColor("--fault"),
      faultStripe: rgbColor("--fault-stripe"),
      fromLight: this.#context.theme.shown.value === "light",
    });
    this.#overlay.readColors();
    this.#layoutDue = true;
  }

  #restore(): void {
    if (this.#array !== undefined) for (let index = 0; index < this.#feeds.length; ++index) this.#upload(index);
    this.#describe();
  }

  #choose(array: ArrayDescription | undefined): void {
    if (array !== this.#array && array?.name !== this.#array?.name) {
      this.#pins = [];
      this.#cursor = -1;
      this.#feeds.forEach(({ frame }, index) => {
        frame.values.fill(NaN);
        frame.statuses.fill(0);
        this.#maps.clear(index);
      });
    }
    this.#array = array;
    if (this.#isShown) this.#follow();
    this.#layoutDue = true;
    this.#describe();
  }

  #follow(): void {
    for (const end of this.#unfollow.splice(0)) end();
    if (this.#array === undefined) return;
    QUANTITIES.forEach((quantity, index) => {
      const feed = this.#feeds[index]!;
      feed.message = undefined;
      this.#unfollow.push(
        this.#context.stream.subscribe(`/${this.#array!.name}/${quantity.name}`, (message) => (feed.message = message)),
      );
    });
  }

  #describe(): void {
    if (this.#array === undefined) return;
    for (const [index, panel] of this.#panels.entries()) {
      panel.describe(this.#array);
      this.#maps.setScale(index, panel.endFor(this.#array));
    }
    this.#mapsDue = true;
  }

  #layOut(array: ArrayDescription): void {
    this.#layoutDue = false;
    this.#panels.forEach((panel, index) => setHidden(panel.element, !this.#isShownMap(index, array)));
    setHidden(this.#uncalibrated, array.calibrated);
    setData(this.element, "calibrated", String(array.calibrated));
    const { width, height, left, top } = this.#room.getBoundingClientRect();
    const pixelRatio = window.devicePixelRatio;
    this.#maps.resize(width, height, pixelRatio);
    this.#overlay.resize(width, height, pixelRatio);
    this.#axes.width = this.#overlay.canvas.width;
    this.#axes.height = this.#overlay.canvas.height;
    this.#areas = this.#panels.map((panel, index) => {
      const plot = panel.plot.getBoundingClientRect();
      const area = panel.element.hidden ? NOWHERE : fitMap({ left: plot.left - left, top: plot.top - top, width: plot.width, height: plot.height }, array);
      this.#maps.place(index, area);
      return area;
    });
    drawAxes(this.#axes, this.#areas, array, pixelRatio);
    drawZones(this.#zones, this.#areas[FORCE], array);
    this.#mapsDue = true;
    this.#overlayDue = true;
    this.#textDue = true;
  }

  #decode(array: ArrayDescription): void {
    for (const [index, feed] of this.#feeds.entries()) {
      const { message } = feed;
      if (message === undefined) continue;
      feed.message = undefined;
      (index === 0 ? readCounts : readGrid)(message, feed.frame);
      if (feed.frame.rows !== array.rows || feed.frame.cols !== array.cols) continue;
      this.#upload(index);
      if (index === FORCE) this.#context.display.drawn(feed.frame.stampS);
    }
  }

  #upload(index: number): void {
    const { rows, cols, values, statuses } = this.#feeds[index]!.frame;
    if (rows === 0) return;
    const known = this.#feeds[FORCE]!.frame.statuses;
    const areKnown = this.#array?.calibrated === true && known.length === statuses.length;
    this.#maps.setValues(index, rows, cols, values, areKnown ? known : statuses);
    this.#mapsDue = true;
    this.#textDue = true;
  }

  #drawContacts(array: ArrayDescription): void {
    const live = this.#context.live.arrays[this.#context.suit.indexOf(array.name)];
    const hasNews = live !== undefined && live.version !== this.#contactsVersion;
    if (!hasNews && !this.#overlayDue) return;
    this.#contactsVersion = live?.version ?? -1;
    this.#overlayDue = false;
    this.#textDue = true;
    this.#overlay.draw(this.#areas, array, live, this.#cursor, this.#pins);
  }

  #showText(array: ArrayDescription, nowMs: number): void {
    this.#textMs = nowMs;
    this.#textDue = false;
    const [raw, conductance, force] = this.#feeds.map(({ frame }) => frame) as [GridFrame, GridFrame, GridFrame];
    this.#taxels.show(array, { raw, conductance, force }, this.#cursor, this.#pins);
    setData(this.element, "stamp", fixed(force.stampS, 6));
    setData(this.element, "frames", String(this.#context.display.framesDrawn));
    const live = this.#context.live.arrays[this.#context.suit.indexOf(array.name)];
    if (live === undefined) return;
    this.#contacts.show(live);
    this.#summary.show(array, live, array.calibrated ? force : raw);
  }

  #taxelUnder(event: MouseEvent): number {
    if (this.#array === undefined) return -1;
    const { left, top } = this.#room.getBoundingClientRect();
    for (const area of this.#areas) {
      const taxel = taxelAt(area, this.#array, event.clientX - left, event.clientY - top);
      if (taxel >= 0) return taxel;
    }
    return -1;
  }

  #point(event: PointerEvent): void {
    this.#moveCursor(this.#taxelUnder(event));
  }

  #moveCursor(taxel: number): void {
    if (taxel === this.#cursor) return;
    this.#cursor = taxel;
    this.#overlayDue = true;
    this.#textDue = true;
    this.#textMs = 0;
  }

  #pin(taxel: number): void {
    if (taxel < 0) return;
    const place = this.#pins.indexOf(taxel);
    if (place >= 0) this.#pins.splice(place, 1);
    else if (this.#pins.length < MOST_PINS) this.#pins.push(taxel);
    this.#overlayDue = true;
    this.#textDue = true;
  }

  #steer(event: KeyboardEvent): void {
    const array = this.#array;
    if (array === undefined || event.target !== this.#room) return;
    const row = Math.floor(Math.max(0, this.#cursor) / array.cols);
    const col = Math.max(0, this.#cursor) % array.cols;
    const to = (newRow: number, newCol: number): void => {
      const inside = Math.min(array.rows - 1, Math.max(0, newRow)) * array.cols + Math.min(array.cols - 1, Math.max(0, newCol));
      this.#moveCursor(this.#cursor < 0 ? 0 : inside);
    };
    if (event.key === "ArrowLeft") to(row, col - 1);
    else if (event.key === "ArrowRight") to(row, col + 1);
    else if (event.key === "ArrowUp") to(row - 1, col);
    else if (event.key === "ArrowDown") to(row + 1, col);
    else if (event.key === "Enter") this.#pin(this.#cursor);
    else if (event.key === "Escape") this.#moveCursor(-1);
    else return;
    event.preventDefault();
    event.stopPropagation();
    this.#speak(array);
  }

  #speak(array: ArrayDescription): void {
    const force = this.#feeds[FORCE]!.frame;
    const newtons = fixed(force.values[this.#cursor] ?? NaN, 2);
    const counts = fixed(this.#feeds[RAW]!.frame.values[this.#cursor] ?? NaN, 0);
    const reading = array.calibrated ? `${newtons} newtons, ${statusWord(force.statuses[this.#cursor] ?? 0)}` : `${counts} counts`;
    const words = `${taxelName(this.#cursor, array)}: ${reading}`;
    setText(this.#spoken, this.#cursor < 0 ? "" : words);
  }
}

export const createArrayView: ViewFactory = (context) => new ArrayView(context);
