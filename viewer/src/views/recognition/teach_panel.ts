// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { button, element, panel, setHidden, setText } from "../../dom";
import { errorText, fixed } from "../../format";
import { KeyedRows, type Row } from "../../keyed_rows";
import { rgbOf } from "../../render/color_map";
import type { Stream } from "../../stream/stream";
import type { ArrayDescription } from "../../suit";
import { byClass, missing, type TaughtTouch, WANTED_EXAMPLES, warnings } from "./taught_touches";

const POLL_MS = 250;
/** Services that are called without being asked for. */
const SILENT = ["/recognition/examples", "/recognition/saved"];

interface Examples {
  listening: string;
  touched: boolean;
  examples: TaughtTouch[];
}

interface Trained {
  file: string;
  classes: string[];
  accuracy: number;
  judged: number;
  advice: string[];
}

/** A touch as a small picture that can be thrown away. */
function thumbnail(
  { id, picture = [] }: TaughtTouch,
  { rows, cols }: ArrayDescription,
  throwAway: () => void,
): HTMLElement {
  const canvas = element("canvas", { width: cols, height: rows, "aria-hidden": "true" });
  const pen = canvas.getContext("2d")!;
  const image = pen.createImageData(cols, rows);
  picture.forEach((brightness, taxel) =>
    image.data.set([...rgbOf(brightness / 255).map((share) => 255 * share), 255], 4 * taxel),
  );
  pen.putImageData(image, 0, 0);
  return element(
    "button",
    {
      class: "example",
      title: "Throw this example away",
      "aria-label": `Throw example ${id} away`,
      "data-example": id,
      onclick: throwAway,
    },
    canvas,
    element("span", { "aria-hidden": "true" }, "\u00d7"),
  );
}

/** A class and its examples. */
class TaughtClass implements Row<[string, TaughtTouch[]]> {
  readonly element: HTMLElement;
  readonly #title = element("strong");
  readonly #list = element("span", { class: "examples" });
  readonly #examples: KeyedRows<TaughtTouch>;

  constructor(name: string, picture: (touch: TaughtTouch) => HTMLElement) {
    this.element = element("li", { "data-taught": name }, this.#title, this.#list);
    this.#examples = new KeyedRows(
      this.#list,
      ({ id }) => String(id),
      (touch) => ({ element: picture(touch) }),
    );
  }

  show([name, touches]: [string, TaughtTouch[]]): void {
    setText(this.#title, `${name} (${touches.length})`);
    this.#examples.show(touches);
  }
}

/** Names touches, collects them and has classes learned of them. */
export class TeachPanel {
  readonly element: HTMLElement;
  readonly #stream: Stream;
  readonly #onTrained: (classes: string[]) => void;
  readonly #name = element("input", {
    class: "field",
    "data-role": "teach-class",
    maxlength: 40,
    placeholder: "such as tap",
  });
  readonly #session = element("input", { class: "field", "data-role": "teach-session", maxlength: 20, value: "1" });
  readonly #listen = element(
    "button",
    { class: "button primary", "data-role": "teach-listen", type: "submit" },
    "Begin",
  );
  readonly #train = button("Train", () => void this.#learn(), { "data-role": "teach-train", disabled: true });
  readonly #saved = element("select", { class: "field", "data-role": "teach-saved" });
  readonly #before = element(
    "div",
    { class: "teach-form", "data-role": "teach-before", hidden: true },
    element("label", {}, "Taught before", this.#saved),
    button("Load", () => void this.#load(), { "data-role": "teach-load" }),
  );
  readonly #status = element("p", { class: "note", role: "status", "data-role": "teach-status" });
  readonly #taught = element("ul", { class: "taught", "data-role": "taught" });
  readonly #classes = new KeyedRows<[string, TaughtTouch[]]>(
    this.#taught,
    ([name]) => name,
    ([name]) => new TaughtClass(name, (touch) => this.#picture(touch)),
  );
  readonly #warnings = element("ul", { class: "note dim", "data-role": "teach-warnings" });
  readonly #lines = new KeyedRows<string>(
    this.#warnings,
    (line) => line,
    (line) => ({ element: element("li", {}, line) }),
  );
  readonly #result = element("ul", { class: "note", "data-role": "teach-result" });
  #array: ArrayDescription | undefined;
  #known = 0;
  #listening = "";
  #pollMs = 0;
  #isBusy = false;

  constructor(stream: Stream, onTrained: (classes: string[]) => void) {
    this.#stream = stream;
    this.#onTrained = onTrained;
    const form = element(
      "form",
      { class: "teach-form" },
      element("label", {}, "Class", this.#name),
      element("label", {}, "Session", this.#session),
      this.#listen,
      this.#train,
    );
    this.#train.type = "button";
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      void this.#toggle();
    });
    this.element = panel(
      "Teach touches",
      { "data-role": "teach" },
      form,
      this.#before,
      this.#status,
      this.#taught,
      this.#warnings,
      this.#result,
    );
    stream.services.follow((services) => {
      setHidden(this.element, !services.has("/recognition/listen"));
      if (services.has("/recognition/saved")) void this.#listSaved();
    });
  }

  begin(array: ArrayDescription): void {
    this.#array = array;
    this.#known = 0;
    this.#classes.show([]);
    this.#result.replaceChildren();
    void this.#listSaved();
  }

  draw(nowMs: number): void {
    if (this.element.hidden || this.#isBusy || nowMs - this.#pollMs < POLL_MS) return;
    this.#pollMs = nowMs;
    void this.#work(() => this.#poll());
  }

  async #toggle(): Promise<void> {
    const name = this.#listening === "" ? this.#name.value.trim() : "";
    if (this.#listening === "" && name === "") return this.#name.focus();
    await this.#call("/recognition/listen", { class: name, session: this.#session.value.trim() });
    await this.#poll();
  }

  async #learn(): Promise<void> {
    setText(this.#status, "Training \u2026");
    const trained = (await this.#call("/recognition/train", {})) as Trained | undefined;
    if (trained === undefined) return;
    const right = `${fixed(100 * trained.accuracy, 0)} % of ${trained.judged} examples were right when left out. Saved as ${trained.file} and in use.`;
    this.#result.replaceChildren(...[right, ...trained.advice].map((line) => element("li", {}, line)));
    this.#onTrained(trained.classes);
  }

  /** Lists touches that were saved another day and are not among the examples. */
  async #listSaved(): Promise<void> {
    const array = this.#array;
    if (array === undefined) return;
    const answer = (await this.#call("/recognition/saved", {})) as { files: string[] } | undefined;
    if (array !== this.#array) return;
    const files = answer?.files ?? [];
    this.#saved.replaceChildren(...files.map((file) => element("option", { value: file }, file)));
    setHidden(this.#before, files.length === 0);
  }

  async #load(): Promise<void> {
    const loaded = await this.#call("/recognition/load", { file: this.#saved.value });
    if (loaded === undefined) return;
    await this.#listSaved();
    await this.#poll();
  }

  async #poll(): Promise<void> {
    const array = this.#array;
    const answer = (await this.#call("/recognition/examples", { known: this.#known })) as Examples | undefined;
    if (answer === undefined || array !== this.#array || array === undefined) return;
    this.#listening = answer.listening;
    this.#known = Math.max(this.#known, ...answer.examples.map(({ id }) => id));
    this.#show(answer);
  }

  #show({ listening, touched, examples }: Examples): void {
    setText(this.#listen, listening === "" ? "Begin" : "Stop");
    this.#name.disabled = this.#session.disabled = listening !== "";
    const count = examples.filter((touch) => touch.class === listening).length;
    const asked = touched
      ? "Touched: let go."
      : count >= WANTED_EXAMPLES
        ? "Enough: stop, and teach the next class."
        : "Touch the array, and let go.";
    const lacking = missing(examples);
    setText(
      this.#status,
      listening !== ""
        ? `${listening}: ${count} of ${WANTED_EXAMPLES}. ${asked}`
        : lacking !== ""
          ? `Name a class and begin. ${lacking}`
          : "Name another class, or train.",
    );
    this.#train.disabled = listening !== "" || lacking !== "";
    this.#classes.show([...byClass(examples)]);
    this.#lines.show(warnings(examples));
  }

  #picture(touch: TaughtTouch): HTMLElement {
    const throwAway = (): void => void this.#call("/recognition/throw_away", { example: touch.id });
    return thumbnail(touch, this.#array!, throwAway);
  }

  /** One call of the poll at a time. */
  async #work(task: () => Promise<void>): Promise<void> {
    this.#isBusy = true;
    try {
      await task();
    } finally {
      this.#isBusy = false;
    }
  }

  async #call(service: string, request: object): Promise<unknown> {
    try {
      return await this.#stream.callService(service, { array: this.#array?.name ?? "", ...request });
    } catch (error) {
      if (!SILENT.includes(service))
        this.#result.replaceChildren(element("li", { class: "attention" }, errorText(error)));
      return undefined;
    }
  }
}
