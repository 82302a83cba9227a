// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { button, element, setData, setText } from "../../dom";
import { fixed } from "../../format";
import { type PointsFrame, readPoints } from "../../messages/grids";
import { readTransforms } from "../../messages/transforms";
import { setting } from "../../settings";
import type { View, ViewContext, ViewFactory } from "../../view";
import { asOnMap, isLoneAndFlat } from "./as_on_map";
import { OrientationGizmo } from "./orientation_gizmo";
import { SideLabels } from "./side_labels";
import type { SuitScene } from "./suit_scene";
import "./suit.css";

const ENDS_N = [0.5, 1, 2, 5, 10, 20, 50, 100];
const LABEL_PERIOD_MS = 200;
const CLICK_PIXELS = 4;
const MOST_FORCES = 24;

/** The name and total force of an array, beside its place. */
class ArrayLabel {
  readonly element: HTMLElement;
  readonly #force = element("span", { class: "figure" });

  constructor(name: string, open: () => void) {
    this.element = element(
      "button",
      { class: "array-label", onclick: open, "data-array": name, title: `Open ${name}` },
      name,
      this.#force,
    );
  }

  show(newtons: number, isCalibrated: boolean): void {
    setText(this.#force, isCalibrated ? `${fixed(newtons, 1)} N` : " not calibrated");
  }
}

/** An arrow is not longer than the scale. */
function forceText(newtons: number, scaleEnd: number): string {
  return `${fixed(newtons, 1)} N${newtons > scaleEnd ? " (beyond)" : ""}`;
}

/** The middle of what these points of an array are on the picture. */
function middleOf(
  scene: SuitScene,
  array: number,
  points: readonly [number, number, number][],
): [number, number] | undefined {
  const sum: [number, number] = [0, 0];
  for (const point of points) {
    const at = scene.project(...scene.placeOf(array, point));
    if (at === undefined) return undefined;
    sum[0] += at[0] / points.length;
    sum[1] += at[1] / points.length;
  }
  return sum;
}

class SuitView implements View {
  readonly name = "suit";
  readonly title = "Suit";
  readonly element: HTMLElement;
  readonly #context: ViewContext;
  readonly #canvas = element("canvas", { class: "layer" });
  readonly #room: HTMLElement;
  readonly #ticks = element("div", { class: "scale-ticks figure" });
  readonly #end = setting<number>("scale.suit", 10, (value) => ENDS_N.includes(value));
  readonly #frame: PointsFrame = { stampS: 0, newtons: new Float32Array(0), statuses: new Uint8Array(0) };
  readonly #resizing = new ResizeObserver(() => this.#resize());
  readonly #forces = Array.from({ length: MOST_FORCES }, () =>
    element("span", { class: "force-label figure", hidden: true, "aria-hidden": "true" }),
  );
  readonly #sides = new SideLabels();
  readonly #gizmo = new OrientationGizmo();
  readonly #arrowShaft = element("span", { class: "arrow-length" });
  readonly #arrowForce = element("span", { class: "figure" });
  #labels: ArrayLabel[] = [];
  /** Some taxels of each array, with its middle in their middle. */
  #anchors: [number, number, number][][] = [];
  #scene: SuitScene | undefined;
  #isLoading = false;
  #message: DataView | undefined;
  #transforms: DataView | undefined;
  #isPlaced = false;
  #isShown = false;
  /** The message drawn last, and the one that is held while the picture is paused. */
  #drawn: DataView | undefined;
  #held: DataView | undefined;
  #unsubscribe: () => void = () => undefined;
  #contactsVersion = -1;
  #labelMs = 0;
  #pressed: [number, number] = [0, 0];

  constructor(context: ViewContext) {
    this.#context = context;
    this.#room = element(
      "div",
      {
        class: "panel suit-room",
        tabindex: 0,
        role: "application",
        "aria-label": "The suit. Arrow keys turn it, plus and minus bring it nearer, Home shows all arrays.",
        "data-role": "suit",
      },
      this.#canvas,
      this.#sides.lines,
      ...this.#forces,
      element("p", { class: "arrow-scale" }, this.#arrowShaft, this.#arrowForce),
      this.#gizmo.element,
    );
    this.element = element("div", { class: "view suit-view", "data-view": "suit" }, this.#makeToolbar(), this.#room);
    this.#room.addEventListener("pointerdown", ({ clientX, clientY }) => (this.#pressed = [clientX, clientY]));
    this.#room.addEventListener("click", (event) => this.#click(event));
    this.#room.addEventListener("keydown", (event) => this.#steer(event));
    context.suit.description.follow(() => this.#describe());
    context.suit.selected.follow((array) =>
      this.#scene?.choose(array === undefined ? -1 : context.suit.indexOf(array.name)),
    );
    context.theme.shown.follow(() => this.#scene?.readColors());
    context.paused.follow((isPaused) => this.#pause(isPaused));
    this.#end.follow((end) => this.#setScale(end));
  }

  show(): void {
    void this.#load();
    this.#resizing.observe(this.#room);
    this.#isShown = true;
    this.#follow();
  }

  hide(): void {
    this.#isShown = false;
    if (!this.#context.paused.value || this.#held !== undefined) this.#unsubscribe();
    this.#resizing.disconnect();
  }

  #follow(): void {
    this.#unsubscribe();
    const { stream } = this.#context;
    const ends = [
      stream.subscribe("/suit/points", (message) => this.#hear(message)),
      stream.subscribe("/tf", (message) => (this.#transforms = message)),
    ];
    this.#unsubscribe = () => ends.splice(0).forEach((end) => end());
  }

  /** While the picture stands, it is the one of the moment of the pause, also where the view is opened later. */
  #hear(message: DataView): void {
    if (this.#context.paused.value) {
      if (this.#held !== undefined) return;
      this.#held = message;
      if (!this.#isShown) this.#unsubscribe();
    }
    this.#message = message;
  }

  #pause(isPaused: boolean): void {
    this.#held = isPaused && this.#isShown ? (this.#message ?? this.#drawn) : undefined;
    if (this.#isShown) return;
    if (isPaused) this.#follow();
    else this.#unsubscribe();
  }

  draw(nowMs: number): void {
    const scene = this.#scene;
    if (scene === undefined) return;
    const { live, paused, display } = this.#context;
    const message = this.#message;
    if (message !== undefined) {
      this.#message = undefined;
      this.#drawn = message;
      readPoints(message, this.#frame);
      scene.setForces(this.#frame);
      display.drawn(this.#frame.stampS);
      setData(this.element, "stamp", fixed(this.#frame.stampS, 6));
    }
    if (this.#transforms !== undefined && (!paused.value || !this.#isPlaced)) {
      this.#isPlaced = true;
      scene.setTransforms(readTransforms(this.#transforms));
      this.#transforms = undefined;
    }
    if (live.version !== this.#contactsVersion) {
      this.#contactsVersion = live.version;
      scene.setContacts(
        live.arrays.map(({ contacts }) => contacts),
        this.#end.value,
      );
      this.#forces.forEach((label, index) => setText(label, forceText(scene.arrowForce(index), this.#end.value)));
    }
    if (scene.draw()) this.#placeLabels(scene);
    if (nowMs - this.#labelMs >= LABEL_PERIOD_MS) this.#showTotals(nowMs);
  }

  async #load(): Promise<void> {
    if (this.#isLoading) return;
    this.#isLoading = true;
    const { SuitScene } = await import("./suit_scene");
    const { stream } = this.#context;
    const failed = (why: string): void => {
      stream.notice.value = { level: 1, message: `The body is not shown whole. ${why}` };
    };
    this.#scene = new SuitScene(this.#canvas, (path) => stream.fetchFile(path), failed);
    this.#describe();
    this.#resize();
  }

  #makeToolbar(): HTMLElement {
    const select = element(
      "select",
      {
        class: "field compact",
        "aria-label": "End of the force scale",
        onchange: () => (this.#end.value = Number(select.value)),
      },
      ...ENDS_N.map((end) => element("option", { value: end, selected: end === this.#end.value }, `0 \u2013 ${end} N`)),
    );
    const strip = element("div", { class: "scale-strip" });
    return element(
      "div",
      { class: "toolbar" },
      element("div", { class: "scale suit-scale" }, strip, this.#ticks),
      select,
      button("Whole suit", () => this.#scene?.home()),
      element("p", { class: "dim" }, "Drag to turn, scroll to come nearer, click an array to open it"),
    );
  }

  #setScale(end: number): void {
    this.#ticks.replaceChildren(
      ...[0, 0.25, 0.5, 0.75, 1].map((share) =>
        element("span", { style: `left: ${100 * share}%` }, String(share * end)),
      ),
    );
    setText(this.#arrowForce, `${end} N`);
    this.#contactsVersion = -1;
    this.#scene?.setScale(end);
  }

  #describe(): void {
    const { suit } = this.#context;
    const isTurned = isLoneAndFlat(suit.description.value);
    const shown = isTurned ? asOnMap(suit.description.value) : suit.description.value;
    const { arrays } = shown;
    if (this.#scene === undefined || arrays.length === 0) return;
    this.#scene.setSuit(shown, isTurned);
    this.#scene.setScale(this.#end.value);
    this.#scene.choose(suit.indexOf(suit.selected.value?.name ?? ""));
    for (const label of this.#labels) label.element.remove();
    this.#labels = arrays.map(({ name }) => new ArrayLabel(name, () => this.#context.open("array", name)));
    this.#anchors = arrays.map(({ positions, rows, cols }) =>
      [0, Math.floor(rows / 2), rows - 1].flatMap((row) =>
        [0, Math.floor(cols / 2), cols - 1].map((col) => positions[row * cols + col]!),
      ),
    );
    this.#room.append(...this.#labels.map((label) => label.element));
  }

  #resize(): void {
    this.#scene?.resize(this.#room.clientWidth, this.#room.clientHeight, window.devicePixelRatio);
  }

  #placeLabels(scene: SuitScene): void {
    const arrays = this.#labels.map(({ element }, index) => ({
      label: element,
      at: middleOf(scene, index, this.#anchors[index]!),
    }));
    const forces = this.#forces.map((label, index) => ({
      label,
      at: index < scene.arrowCount ? scene.arrowPlace(index) : undefined,
    }));
    this.#sides.place([...arrays, ...forces], this.#room.clientWidth, this.#room.clientHeight);
    this.#gizmo.show(scene.axes());
    this.#arrowShaft.style.width = `${scene.longestArrow.toFixed(1)}px`;
  }

  #showTotals(nowMs: number): void {
    this.#labelMs = nowMs;
    const { arrays } = this.#context.suit.description.value;
    this.#labels.forEach((label, index) =>
      label.show(this.#context.live.arrays[index]?.contacts.totalForceN ?? NaN, arrays[index]?.calibrated === true),
    );
  }

  #click(event: MouseEvent): void {
    const [x, y] = this.#pressed;
    if (event.target !== this.#canvas || Math.hypot(event.clientX - x, event.clientY - y) > CLICK_PIXELS) return;
    const { left, top } = this.#room.getBoundingClientRect();
    const array = this.#scene?.arrayAt(event.clientX - left, event.clientY - top) ?? -1;
    if (array >= 0) this.#context.open("array", this.#context.suit.description.value.arrays[array]!.name);
  }

  #steer(event: KeyboardEvent): void {
    const scene = this.#scene;
    if (scene === undefined || event.target !== this.#room) return;
    if (event.key === "ArrowLeft") scene.turn(-1, 0);
    else if (event.key === "ArrowRight") scene.turn(1, 0);
    else if (event.key === "ArrowUp") scene.turn(0, 1);
    else if (event.key === "ArrowDown") scene.turn(0, -1);
    else if (event.key === "+" || event.key === "=") scene.zoom(1);
    else if (event.key === "-") scene.zoom(-1);
    else if (event.key === "Home") scene.home();
    else return;
    event.preventDefault();
    event.stopPropagation();
  }
}

export const createSuitView: ViewFactory = (context) => new SuitView(context);
