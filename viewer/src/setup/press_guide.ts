// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { button, element, setHidden, setText } from "../dom";
import { errorText } from "../format";
import type { Stream } from "../stream/stream";
import { doubtsOf, gridMarks, type Mark, millimetresOf, type Pressed, taskOf } from "./pressed_places";
import type { Shape } from "./touch_feed";

const PERIOD_MS = 120;
const MOST_PIXELS = 480;

/** Somebody presses place after place, of a grid or of marks on a picture: then it is known which channel is where. */
export class PressGuide {
  readonly element: HTMLElement;
  readonly #stream: Stream;
  readonly #sent: () => Shape | undefined;
  readonly #begins: () => void;
  readonly #words = element("p", { role: "status", "data-role": "press-words" });
  readonly #doubts = element("ul", { class: "dim", "data-role": "press-doubts" });
  readonly #canvas = element("canvas", { hidden: true, role: "img", "aria-label": "Your picture" });
  readonly #marks = element("div", { class: "press-marks", "data-role": "press-marks" });
  readonly #room = element("div", { class: "press-room" }, this.#canvas, this.#marks);
  readonly #rows = lines("press-rows");
  readonly #cols = lines("press-cols");
  readonly #distance = element("input", {
    id: "press-distance",
    class: "field",
    type: "number",
    min: 0.1,
    step: "any",
  });
  readonly #keys: HTMLElement;
  readonly #use: HTMLButtonElement;
  #picture: Mark[] | undefined;
  #round = 0;

  /** `sent`: the shape of the frames. `begins`: the source is needed here now. `use`: what was pressed is to be used. */
  constructor(stream: Stream, sent: () => Shape | undefined, begins: () => void, use: () => void) {
    this.#stream = stream;
    this.#sent = sent;
    this.#begins = begins;
    const file = element("input", { id: "press-picture", class: "field", type: "file", accept: "image/*" });
    file.addEventListener("change", () => void this.#load(file.files?.[0]));
    this.#room.addEventListener("click", (event) => this.#mark(event));
    for (const input of [this.#rows, this.#cols]) input.addEventListener("input", () => this.#draw(undefined));
    this.#keys = element(
      "div",
      { class: "setup-row", hidden: true },
      button("Nothing answers here", () => void this.#skip(false), { "data-role": "press-skip" }),
      button("The last one again", () => void this.#skip(true), { "data-role": "press-back" }),
    );
    this.#use = button("Use this order", use, { class: "primary", "data-role": "press-use", hidden: true });
    this.element = element(
      "details",
      { class: "press-guide", "data-role": "press-guide" },
      element("summary", {}, "Press each place"),
      element(
        "div",
        { class: "press-fields" },
        element(
          "p",
          { class: "dim" },
          "Where channels are wired in an unknown order, or taxels are in no grid: press them one after another. c5 is channel 5, counted from 0.",
        ),
        ...field("Rows of places", this.#rows),
        ...field("Columns of places", this.#cols),
        ...field("Or a picture, to mark them on (it stays in this browser)", file),
        ...field("From mark 1 to mark 2 [mm]", this.#distance),
        this.#room,
        button("Begin to press", () => void this.#begin(), { "data-role": "press-begin" }),
        this.#words,
        this.#keys,
        this.#doubts,
        this.#use,
      ),
    );
  }

  /** Another source, or another shape: nothing is known of its places. */
  forget(): void {
    this.#round += 1;
    const shape = this.#sent();
    this.#rows.value = shape === undefined ? "" : String(shape.rows);
    this.#cols.value = shape === undefined ? "" : String(shape.cols);
    for (const part of [this.#keys, this.#use]) setHidden(part, true);
    setText(this.#words, "");
    this.#doubts.replaceChildren();
    this.#draw(undefined);
  }

  async #load(file: File | undefined): Promise<void> {
    if (file === undefined) return;
    try {
      const picture = await createImageBitmap(file);
      const scale = Math.min(1, MOST_PIXELS / Math.max(picture.width, picture.height));
      this.#canvas.width = Math.max(1, Math.round(scale * picture.width));
      this.#canvas.height = Math.max(1, Math.round(scale * picture.height));
      this.#canvas.getContext("2d")?.drawImage(picture, 0, 0, this.#canvas.width, this.#canvas.height);
      this.#picture = [];
      setHidden(this.#canvas, false);
      setText(
        this.#words,
        "Click on each place, in the order in which you will press them. A click on the last mark takes it away.",
      );
      this.#draw(undefined);
    } catch {
      setText(this.#words, "This is no picture.");
    }
  }

  #mark(event: MouseEvent): void {
    if (this.#picture === undefined || !this.#keys.hidden) return;
    const { left, top, width, height } = this.#canvas.getBoundingClientRect();
    const mark: Mark = [(event.clientX - left) / width, (event.clientY - top) / height];
    const last = this.#picture.at(-1);
    const isLast = last !== undefined && Math.hypot((mark[0] - last[0]) * width, (mark[1] - last[1]) * height) < 10;
    if (isLast) this.#picture.pop();
    else this.#picture.push(mark);
    this.#draw(undefined);
  }

  #grid(): Shape | undefined {
    const shape = { rows: this.#rows.valueAsNumber, cols: this.#cols.valueAsNumber };
    return this.#rows.checkValidity() && this.#cols.checkValidity() && shape.rows * shape.cols <= 1024
      ? shape
      : undefined;
  }

  #draw(pressed: Pressed | undefined): void {
    const grid = this.#picture === undefined ? this.#grid() : undefined;
    const marks = this.#picture ?? (grid === undefined ? [] : gridMarks(grid));
    this.#room.style.aspectRatio = grid === undefined ? "" : `${grid.cols} / ${grid.rows}`;
    const places = marks.map(([x, y], place) => {
      const channel = pressed?.channels[place] ?? null;
      const isNow = pressed?.ready === true && pressed.place === place;
      const state = isNow ? "now" : channel !== null ? "known" : pressed && place < pressed.place ? "silent" : "";
      const style = `left: ${(100 * x).toFixed(2)}%; top: ${(100 * y).toFixed(2)}%`;
      return element(
        "span",
        { class: "press-mark", "data-state": state, style },
        channel === null ? String(place + 1) : `c${channel}`,
      );
    });
    this.#marks.replaceChildren(...places);
  }

  /** The places as /array/press takes them; undefined: they are not known yet. */
  #places(): object | undefined {
    const { width, height } = this.#canvas;
    if (this.#picture === undefined) {
      const pitch = document.querySelector<HTMLInputElement>("#array-pitch")?.valueAsNumber ?? 10;
      const grid = this.#grid();
      return grid && { ...grid, pitch_um: Math.round(1000 * pitch) };
    }
    const places_mm = millimetresOf(this.#picture, width, height, this.#distance.valueAsNumber);
    return places_mm && { places_mm };
  }

  async #begin(): Promise<void> {
    const [sent, places] = [this.#sent(), this.#places()];
    if (sent === undefined || places === undefined) {
      const lacks = this.#picture === undefined ? "rows and columns" : "two marks or more, and how far 1 is from 2";
      setText(this.#words, `Fill in ${sent === undefined ? "the rows and columns that are sent" : lacks} first.`);
      return;
    }
    this.#begins();
    const round = ++this.#round;
    try {
      const request = { ...places, sent_rows: sent.rows, sent_cols: sent.cols };
      this.#show((await this.#stream.callService("/array/press", request)) as Pressed);
      while (round === this.#round) {
        const pressed = (await this.#stream.callService("/array/pressed", {})) as Pressed;
        if (round !== this.#round) return;
        this.#show(pressed);
        if (pressed.problem !== "") return;
        await new Promise((resolve) => window.setTimeout(resolve, PERIOD_MS));
      }
    } catch (error) {
      setText(this.#words, errorText(error));
    }
  }

  async #skip(back: boolean): Promise<void> {
    try {
      this.#show((await this.#stream.callService("/array/skip", { back })) as Pressed);
    } catch (error) {
      setText(this.#words, errorText(error));
    }
  }

  #show(pressed: Pressed): void {
    setText(this.#words, pressed.problem === "" ? taskOf(pressed) : pressed.problem);
    setHidden(this.#keys, !pressed.ready);
    setHidden(this.#use, !pressed.done || pressed.channels.every((channel) => channel === null));
    this.#doubts.replaceChildren(...doubtsOf(pressed).map((words) => element("li", {}, words)));
    this.#draw(pressed);
  }
}

function lines(id: string): HTMLInputElement {
  return element("input", { id, class: "field", type: "number", min: 1, max: 1024, step: 1 });
}

function field(words: string, input: HTMLElement): HTMLElement[] {
  return [element("label", { for: input.id }, words), input];
}
