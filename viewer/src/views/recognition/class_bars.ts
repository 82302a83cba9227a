// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { element, panel, setData, setHidden, setText } from "../../dom";
import { fixed } from "../../format";
import { KeyedRows, type Row } from "../../keyed_rows";
import type { Classification } from "../../messages/classification";

const UNKNOWN = "unknown";

interface Share {
  name: string;
  probability: number;
  isAnswer: boolean;
}

/** A class, and how probable it is. */
class Bar implements Row<Share> {
  readonly element: HTMLElement;
  readonly #fill = element("span", { class: "class-fill" });
  readonly #share = element("span", { class: "figure" });

  constructor({ name }: Share) {
    const track = element("span", { class: "class-track" }, this.#fill);
    this.element = element(
      "li",
      { "data-class": name },
      element("span", { class: "class-name", title: name }, name),
      track,
      this.#share,
    );
  }

  show({ probability, isAnswer }: Share): void {
    const percent = fixed(100 * probability, 1);
    this.#fill.style.width = Number.isFinite(probability) ? `${percent}%` : "0";
    setText(this.#share, `${percent} %`);
    setData(this.element, "answer", String(isAnswer));
  }
}

/** The touch of an array: the answer, and a bar for each class. */
export class ClassBars {
  readonly element: HTMLElement;
  readonly #answer = element("span", { class: "large answer", "data-role": "answer" });
  readonly #reason = element("span", { class: "dim", "data-role": "reason" });
  readonly #age = element("span", { class: "dim figure", "data-role": "answer-age" });
  readonly #list = element("ul", { class: "class-bars", "data-role": "class-bars" });
  readonly #none = element("p", { class: "dim note" });
  readonly #bars = new KeyedRows<Share>(
    this.#list,
    ({ name }) => name,
    (share) => new Bar(share),
  );
  #names: readonly string[] = [];

  constructor() {
    this.element = panel(
      [element("h2", {}, "What touches"), element("span", { class: "stretch" }), this.#age],
      { "aria-label": "What touches" },
      element("p", { class: "answer-line", "aria-live": "polite" }, this.#answer, this.#reason),
      this.#list,
      this.#none,
    );
  }

  /** Nothing was recognised yet. */
  begin(array: string, classes: readonly string[]): void {
    this.#names = classes;
    this.#bars.show(classes.map((name) => ({ name, probability: 0, isAnswer: false })));
    setHidden(this.#list, classes.length === 0);
    setHidden(this.#none, classes.length > 0);
    setText(
      this.#none,
      `No classes are served for ${array}: learn them (dermis recognise learn) and serve them (dermis serve --classes), or teach them here.`,
    );
    setText(this.#answer, "");
    setText(this.#reason, classes.length > 0 ? "nothing was recognised yet" : "");
    setText(this.#age, "");
  }

  show({ answer, reason, classes, stampS }: Classification): void {
    setData(this.element, "stamp", fixed(stampS, 6));
    setText(this.#answer, answer);
    setData(this.#answer, "unknown", String(answer === UNKNOWN && reason !== ""));
    const [first, second] = classes;
    const between =
      first !== undefined && second !== undefined
        ? `: ${first.name} ${fixed(100 * first.probability, 0)} %, ${second.name} ${fixed(100 * second.probability, 0)} %`
        : "";
    setText(
      this.#reason,
      reason === ""
        ? `${fixed(100 * (first?.probability ?? NaN), 1)} %`
        : `${reason}${reason.startsWith("between") ? between : ""}`,
    );
    const shares = new Map(classes.map(({ name, probability }) => [name, probability]));
    this.#bars.show(
      this.#names.map((name) => ({
        name,
        probability: shares.get(name) ?? 0,
        isAnswer: name === answer && reason === "",
      })),
    );
  }

  showAge(seconds: number): void {
    setText(this.#age, seconds >= 0.5 ? `${fixed(seconds, 0)} s ago` : "now");
  }
}
