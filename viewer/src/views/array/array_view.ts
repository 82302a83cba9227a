// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { button, element, setData, setHidden, setText } from "../../dom";
import { fixed, statusWord } from "../../format";
import type { ArrayLive } from "../../live/live_data";
import { regionName } from "../../live/region_force";
import { type Area, HeatMaps } from "../../render/heat_maps";
import { Signal } from "../../signal";
import type { ArrayDescription } from "../../suit";
import { rgbColor } from "../../theme";
import type { View, ViewContext, ViewFactory } from "../../view";
import { drawAxes } from "./axes";
import { ContactTable } from "./contact_table";
import { Feeds, shownOf } from "./feeds";
import { fitMap, LABEL_MARGIN, sharesOf, taxelAt, taxelName } from "./geometry";
import { MapPanel } from "./map_panel";
import { MapPointer } from "./map_pointer";
import { MapChoices, makeMapToolbar } from "./map_toolbar";
import { Overlay } from "./overlay";
import { Picture } from "./picture";
import { FORCE, QUANTITIES, RAW } from "./quantities";
import { Summary } from "./summary";
import { TaxelTable } from "./taxel_table";
import { drawZones } from "./zones";
import "./array.css";

const TEXT_PERIOD_MS = 100;
const NOWHERE: Area = { left: 0, top: 0, width: 0, height: 0 };

class ArrayView implements View {
  readonly name = "array";
  readonly title = "Array";
  readonly element: HTMLElement;
  readonly #context: ViewContext;
  readonly #choices = new MapChoices();
  readonly #panels = QUANTITIES.map((quantity) => new MapPanel(quantity));
  readonly #feeds = new Feeds();
  readonly #maps: HeatMaps;
  readonly #overlay = new Overlay(element("canvas", { class: "layer", "aria-hidden": "true" }));
  readonly #axes = element("canvas", { class: "layer", "aria-hidden": "true" });
  readonly #zones = element("div", { class: "layer zones", "aria-hidden": "true" });
  readonly #room: HTMLElement;
  readonly #pointer: MapPointer;
  readonly #spoken = element("p", { class: "only-spoken", "aria-live": "polite" });
  readonly #taxels = new TaxelTable();
  readonly #contacts = new ContactTable();
  readonly #summary = new Summary();
  readonly #narrow = window.matchMedia("(max-width: 1279px)");
  readonly #uncalibrated: HTMLElement;
  readonly #resizing = new ResizeObserver(() => (this.#layoutDue = true));
  #isShown = false;
  #array: ArrayDescription | undefined;
  #areas: Area[] = [];
  #layoutDue = true;
  #mapsDue = true;
  #overlayDue = true;
  /** Maps, rings, labels and tables are drawn from this one. */
  readonly #picture = new Picture();
  #keyInTable = "";
  #textDue = true;
  #contactsVersion = -1;
  #textMs = 0;

  constructor(context: ViewContext) {
    this.#context = context;
    this.#maps = new HeatMaps(element("canvas", { class: "layer", "aria-hidden": "true" }), QUANTITIES.length, () =>
      this.#restore(),
    );
    this.#uncalibrated = this.#makeUncalibrated();
    this.#room = this.#makeRoom();
    this.#pointer = new MapPointer(this.#room, this.#choices.drawing, {
      taxelUnder: (event) => this.#taxelUnder(event),
      changed: () => this.#pointed(),
      speak: () => this.#speak(),
      drawn: (region) => (context.live.region.region.value = region),
    });
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
    context.paused.follow((isPaused) => this.#stand(isPaused));
  }

  /** Also where another view is shown now: this one may be opened before the picture goes on. */
  #stand(isPaused: boolean): void {
    this.#feeds.stand(isPaused, this.#isShown);
    if (this.#isShown) return;
    if (isPaused) this.#follow();
    else this.#feeds.end();
  }

  show(): void {
    this.#isShown = true;
    this.#follow();
    this.#resizing.observe(this.#room);
    this.#layoutDue = true;
  }

  hide(): void {
    this.#isShown = false;
    if (!this.#context.paused.value) this.#feeds.end();
    this.#resizing.disconnect();
  }

  draw(nowMs: number): void {
    const array = this.#array;
    if (array === undefined) return;
    if (this.#layoutDue) this.#layOut(array);
    const shown = this.#context.live.arrays[this.#context.suit.indexOf(array.name)];
    this.#decode(array, shown);
    if (shown !== undefined) this.#take(shown);
    if (this.#mapsDue) this.#maps.draw();
    this.#mapsDue = false;
    if (this.#overlayDue) this.#drawMarks(array, shown);
    const isOther = this.#picture.key !== this.#keyInTable;
    if (isOther || (this.#textDue && nowMs - this.#textMs >= TEXT_PERIOD_MS)) this.#showText(array, shown, nowMs);
  }

  /** Where there is a newer map, or news of the contacts. */
  #take(shown: ArrayLive): void {
    if (shown.version === this.#contactsVersion && !this.#mapsDue && !this.#overlayDue) return;
    this.#contactsVersion = shown.version;
    this.#picture.take(shown, this.#feeds.frames[FORCE]!.stampS);
    this.#overlayDue = this.#textDue = true;
  }

  key(event: KeyboardEvent): boolean {
    const { interpolated, contacts } = this.#choices;
    if (event.key === "i") interpolated.value = !interpolated.value;
    else if (event.key === "c") contacts.value = !contacts.value;
    else return false;
    return true;
  }

  #makeToolbar(): HTMLElement {
    const { interpolated, contacts, centre, pressure, narrowMap, share } = this.#choices;
    const { region } = this.#context.live.region;
    interpolated.follow((value) => {
      this.#maps.interpolated = value;
      this.#mapsDue = true;
    });
    for (const signal of [contacts, centre]) signal.follow(() => (this.#overlayDue = true));
    for (const signal of [pressure, narrowMap]) signal.follow(() => (this.#layoutDue = true));
    share.follow((value) => this.#feeds.hold(value));
    const hasRegion = new Signal(false);
    region.follow((drawn) => {
      hasRegion.value = drawn !== undefined;
      this.#overlayDue = true;
    });
    return makeMapToolbar(this.#choices, {
      reset: () => this.#feeds.reset(),
      clearRegion: () => (region.value = undefined),
      hasRegion,
    });
  }

  #makeUncalibrated(): HTMLElement {
    return element(
      "section",
      { class: "panel uncalibrated", "aria-label": "Not calibrated yet", "data-role": "uncalibrated", hidden: true },
      element("h2", {}, "Not calibrated yet"),
      element(
        "p",
        {},
        "The counts are live. Newtons come with a calibration: known weights on single taxels, as the page asks for them.",
      ),
      button("Calibrate", () => this.#context.open("calibration"), {
        class: "primary large-button",
        "data-role": "calibrate",
      }),
    );
  }

  #isShownMap(index: number, { calibrated }: ArrayDescription): boolean {
    if (!calibrated) return index === RAW;
    const { load, narrowMap } = this.#choices;
    if (this.#narrow.matches) return index === (narrowMap.value === FORCE ? load : narrowMap.value);
    return index < FORCE || index === load;
  }

  #makeRoom(): HTMLElement {
    return element(
      "div",
      {
        class: "maps",
        tabindex: 0,
        role: "application",
        "aria-label":
          "Maps of the array. Arrow keys move the cursor, Enter pins the taxel, Escape takes the cursor away.",
        "data-role": "maps",
      },
      ...this.#panels.map((panel) => panel.element).reverse(), // the force first
      this.#uncalibrated,
      this.#maps.canvas,
      this.#axes,
      this.#zones,
      this.#overlay.canvas,
    );
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
    if (this.#array !== undefined) QUANTITIES.forEach((_, index) => this.#upload(index));
    this.#describe();
  }

  #choose(array: ArrayDescription | undefined): void {
    if (array !== this.#array && array?.name !== this.#array?.name) {
      this.#feeds.forget();
      QUANTITIES.forEach((_, index) => this.#maps.clear(index));
    }
    this.#array = array;
    this.#pointer.array = array;
    if (this.#isShown) this.#follow();
    this.#layoutDue = true;
    this.#describe();
  }

  #follow(): void {
    if (this.#array === undefined) this.#feeds.end();
    else this.#feeds.follow(this.#context.stream, this.#array);
  }

  #describe(): void {
    if (this.#array === undefined) return;
    for (const [index, panel] of this.#panels.entries()) {
      panel.describe(this.#array);
      this.#maps.setPlaces(index, this.#array.cols, sharesOf(this.#array));
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
      const area = panel.element.hidden
        ? NOWHERE
        : fitMap(
            { left: plot.left - left, top: plot.top - top, width: plot.width, height: plot.height },
            array,
            index >= FORCE ? LABEL_MARGIN : 0,
          );
      this.#maps.place(index, area);
      return area;
    });
    drawAxes(this.#axes, this.#areas, array, pixelRatio);
    drawZones(this.#zones, this.#areas[this.#choices.load], array);
    this.#mapsDue = true;
    this.#overlayDue = true;
    this.#textDue = true;
  }

  #decode(array: ArrayDescription, shown: ArrayLive | undefined): void {
    const fresh = this.#feeds.decode(array, (stampS) => shown?.has(stampS) === true);
    for (const index of fresh) this.#upload(index);
    if (fresh.includes(FORCE)) this.#context.display.drawn(this.#feeds.frames[FORCE]!.stampS);
    const steps = fresh.filter((index) => this.#panels[index]!.see(this.#feeds.frames[index]!));
    if (steps.length > 0) this.#describe();
  }

  #upload(index: number): void {
    const frame = this.#feeds.frames[index]!;
    const { rows, cols, statuses } = frame;
    if (rows === 0 || this.#array === undefined) return;
    const known = this.#feeds.frames[FORCE]!.statuses;
    const areKnown = this.#array?.calibrated === true && known.length === statuses.length;
    this.#maps.setValues(
      index,
      rows,
      cols,
      shownOf(index, frame, this.#array, this.#feeds.frames[FORCE]!),
      areKnown ? known : statuses,
    );
    this.#mapsDue = true;
    this.#textDue = true;
  }

  #drawMarks(array: ArrayDescription, shown: ArrayLive | undefined): void {
    this.#overlayDue = false;
    const { contacts, centre, load } = this.#choices;
    const { touching, isOnMap } = this.#picture;
    const ringed = shown !== undefined && contacts.value && isOnMap ? touching : [];
    setData(this.element, "rings", ringed.map(({ id }) => id).join(" "));
    this.#overlay.draw(this.#areas, array, {
      load: this.#areas[load] ?? NOWHERE,
      contacts: shown,
      touching: ringed,
      centre: centre.value ? shown?.centre : undefined,
      region: this.#pointer.preview ?? this.#context.live.region.region.value,
      cursor: this.#pointer.cursor,
      pins: this.#pointer.pins,
    });
  }

  #showText(array: ArrayDescription, shown: ArrayLive | undefined, nowMs: number): void {
    this.#textMs = nowMs;
    this.#textDue = false;
    const { live, display } = this.#context;
    const [raw, conductance, force] = this.#feeds.frames;
    this.#taxels.show(
      array,
      { raw: raw!, conductance: conductance!, force: force! },
      this.#pointer.cursor,
      this.#pointer.pins,
    );
    setData(this.element, "stamp", fixed(force!.stampS, 6));
    setData(this.element, "frames", String(display.framesDrawn));
    if (shown === undefined) return;
    this.#keyInTable = this.#picture.key;
    this.#contacts.show(this.#picture, shown.slots, array.calibrated);
    this.#summary.show(array, this.#picture, shown.centre, array.calibrated ? force! : raw!);
    this.#summary.showRegion(live.region.region.value?.array === array.name ? live.region : undefined);
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

  #pointed(): void {
    this.#overlayDue = true;
    this.#textDue = true;
    this.#textMs = 0;
  }

  #speak(): void {
    const { cursor } = this.#pointer;
    if (this.#array === undefined || cursor < 0) {
      setText(this.#spoken, "");
      return;
    }
    const force = this.#feeds.frames[FORCE]!;
    const newtons = fixed(force.values[cursor] ?? NaN, 2);
    const counts = fixed(this.#feeds.frames[RAW]!.values[cursor] ?? NaN, 0);
    const reading = this.#array.calibrated
      ? `${newtons} newtons, ${statusWord(force.statuses[cursor] ?? 0)}`
      : `${counts} counts`;
    const region = this.#pointer.preview;
    setText(
      this.#spoken,
      `${taxelName(cursor, this.#array)}: ${reading}${region === undefined ? "" : `, region ${regionName(region)}`}`,
    );
  }
}

export const createArrayView: ViewFactory = (context) => new ArrayView(context);
