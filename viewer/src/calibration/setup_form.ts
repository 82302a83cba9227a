// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { element, setText } from "../dom";
import type { ArrayDescription } from "../suit";
import {
  DEFAULT_WEIGHTS_N,
  describeWork,
  questionOn,
  readWeights,
  type StartRequest,
  strideOf,
  TAXEL_CHOICES,
  type TaxelChoice,
  taxelsOf,
  type Weights,
} from "./plan";

const SECONDS = { min: 0.05, max: 30, step: "any", required: true } as const;

/** Asks for the weights and taxels of a calibration. */
export class SetupForm {
  readonly element: HTMLElement;
  readonly #weights = element("input", {
    id: "weights",
    class: "field",
    "data-role": "weights",
    value: DEFAULT_WEIGHTS_N.join(", "),
    autocomplete: "off",
  });
  readonly #taxels = element(
    "select",
    { id: "taxels", class: "field", "data-role": "taxels" },
    ...TAXEL_CHOICES.map(({ name, words }) => element("option", { value: name }, words)),
  );
  readonly #hold = element("input", {
    id: "hold",
    class: "field",
    type: "number",
    value: 1,
    "data-role": "hold",
    ...SECONDS,
  });
  readonly #quiet = element("input", {
    id: "quiet",
    class: "field",
    type: "number",
    value: 3,
    "data-role": "quiet",
    ...SECONDS,
    min: 0.2,
  });
  readonly #work = element("p", { "data-role": "work" });
  readonly #start = element(
    "button",
    { class: "button primary large-button", type: "submit", "data-role": "start" },
    "Begin",
  );
  readonly #title = element("h2");
  #array: ArrayDescription | undefined;

  constructor(start: (request: StartRequest) => void, changed: () => void) {
    this.element = element(
      "form",
      { class: "calibration-setup", "data-role": "setup", novalidate: true },
      this.#title,
      element(
        "p",
        {},
        "Put known weights on single taxels; the page tells which and when. A stamp as large as a taxel, weights and a kitchen scale are enough.",
      ),
      ...this.#field("Weights (N, g, kg or kPa)", this.#weights),
      ...this.#field("Taxels", this.#taxels),
      ...this.#field("Hold [s]", this.#hold),
      ...this.#field("Quiet at the beginning [s]", this.#quiet),
      this.#work,
      element(
        "p",
        { class: "dim" },
        "Three weights or more give a pressed taxel a law of its own. Forces above the heaviest are less and less sure. Taxels that are not pressed share what the others taught.",
      ),
      this.#start,
    );
    this.element.addEventListener("input", () => {
      this.#check();
      changed();
    });
    this.element.addEventListener("submit", (event) => {
      event.preventDefault();
      const request = this.#request();
      if (request !== undefined) start(request);
    });
  }

  set(array: ArrayDescription | undefined, isOffered: boolean): void {
    this.#array = array;
    this.#start.dataset.offered = String(isOffered);
    setText(this.#title, `Calibrate ${array?.name ?? ""}`);
    this.#check();
  }

  /** That are to be pressed. */
  get taxels(): number[] {
    return this.#array === undefined ? [] : taxelsOf(this.#taxels.value as TaxelChoice, this.#array);
  }

  #field(words: string, input: HTMLElement): HTMLElement[] {
    return [element("label", { for: input.id }, words), input];
  }

  #written(): Weights | undefined {
    return readWeights(this.#weights.value, this.#array);
  }

  #request(): StartRequest | undefined {
    const weights = this.#written();
    if (
      this.#array === undefined ||
      weights === undefined ||
      !this.#hold.checkValidity() ||
      !this.#quiet.checkValidity()
    )
      return undefined;
    const choice = this.#taxels.value as TaxelChoice;
    return {
      array: this.#array.name,
      weights_n: weights.newtons,
      taxels: { stride: strideOf(choice, this.#array) },
      unloaded_s: Number(this.#quiet.value),
      hold_s: Number(this.#hold.value),
    };
  }

  #check(): void {
    const weights = this.#written();
    const question = weights === undefined || this.#array === undefined ? "" : questionOn(weights.newtons, this.#array);
    const isOffered = this.#start.dataset.offered === "true";
    this.#weights.toggleAttribute("aria-invalid", weights === undefined);
    this.#start.disabled = this.#request() === undefined || !isOffered;
    setText(this.#start, question === "" ? "Begin" : "Begin all the same");
    if (!isOffered) setText(this.#work, "This server offers no calibration: it plays a recording, or it is not there.");
    else if (weights === undefined) {
      setText(this.#work, "Weights: 1 to 16 different ones of 0.01 to 1000 N, as 1, 5, 10 or 100 g, 500 g, 2 kg.");
    } else if (this.#array !== undefined) {
      const work = describeWork(weights.newtons.length * this.taxels.length);
      setText(this.#work, [work, weights.taken, question].filter((words) => words !== "").join(". "));
    }
  }
}
