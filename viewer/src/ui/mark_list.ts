// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { button, element, setHidden } from "../dom";
import { clock } from "../format";
import type { Marks } from "../live/marks";
import type { Mark } from "../messages/mark";
import "./mark_list.css";

/** The marks of a recording on its time line, and below it as words that are edited in place. */
export class MarkList {
  /** Over the time line. */
  readonly ticks = element("div", { class: "mark-ticks", "aria-hidden": "true" });
  readonly element = element("ol", {
    class: "mark-list",
    "aria-label": "Marks of the recording",
    "data-role": "mark-list",
    hidden: true,
  });
  readonly #marks: Marks;
  readonly #seek: (atS: number) => void;
  readonly #fail: (error: unknown) => void;
  #startS = 0;
  #lengthS = 0;

  constructor(marks: Marks, seek: (atS: number) => void, fail: (error: unknown) => void) {
    this.#marks = marks;
    this.#seek = seek;
    this.#fail = fail;
    marks.all.follow(() => this.#show());
  }

  /** For the recording that is played. */
  begin(startS: number, lengthS: number): void {
    [this.#startS, this.#lengthS] = [startS, lengthS];
    this.#show();
  }

  #show(): void {
    const marks = this.#lengthS > 0 && this.#marks.areEdited ? this.#marks.all.value : [];
    setHidden(this.element, marks.length === 0);
    this.element.replaceChildren(...marks.map((mark) => this.#makeItem(mark)));
    this.ticks.replaceChildren(...marks.map((mark) => this.#makeTick(mark)));
  }

  #makeTick({ atS, event }: Mark): HTMLElement {
    const share = (100 * (atS - this.#startS)) / this.#lengthS;
    return element("span", {
      class: event === "" ? "mark-tick" : "mark-tick of-server",
      style: `left: ${Math.min(100, Math.max(0, share))}%`,
    });
  }

  #makeItem(mark: Mark): HTMLElement {
    const time = clock(Math.max(0, mark.atS - this.#startS));
    const go = button(time, () => this.#seek(mark.atS - this.#startS), { class: "compact", title: "Go there" });
    if (mark.event !== "")
      return element("li", { class: "of-server" }, go, element("span", { class: "dim" }, mark.label));
    const label = element("input", {
      class: "field compact",
      value: mark.label,
      placeholder: "the label ends",
      "aria-label": `Label at ${time}`,
      maxlength: 60,
      onchange: () => this.#replace(mark, { ...mark, label: label.value.trim() }),
    });
    const remove = button("\u00d7", () => this.#replace(mark), {
      class: "compact",
      title: "Take this mark away",
      "aria-label": `Take the mark at ${time} away`,
    });
    return element("li", {}, go, label, remove);
  }

  #replace(mark: Mark, by?: Mark): void {
    const rest = this.#marks.all.value.filter((one) => one !== mark);
    this.#marks.replace(by === undefined ? rest : [...rest, by]).catch(this.#fail);
  }
}
