// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { element, setText } from "../dom";

const RADIUS = 52;
const LENGTH = 2 * Math.PI * RADIUS;
const SVG = "http://www.w3.org/2000/svg";

function circle(name: string): SVGCircleElement {
  const result = document.createElementNS(SVG, "circle");
  result.setAttribute("cx", "60");
  result.setAttribute("cy", "60");
  result.setAttribute("r", String(RADIUS));
  result.setAttribute("class", name);
  return result;
}

/** A share as a ring that closes, with words inside. */
export class HoldRing {
  readonly element: HTMLElement;
  readonly #arc = circle("ring-arc");
  readonly #large = element("span", { class: "ring-large", "data-role": "weight" });
  readonly #small = element("span", { class: "dim" });

  constructor() {
    const picture = document.createElementNS(SVG, "svg");
    picture.setAttribute("viewBox", "0 0 120 120");
    picture.setAttribute("aria-hidden", "true");
    picture.append(circle("ring-track"), this.#arc);
    this.#arc.setAttribute("stroke-dasharray", String(LENGTH));
    this.element = element(
      "div",
      { class: "ring", role: "progressbar", "aria-label": "Hold", "aria-valuemin": 0, "aria-valuemax": 100 },
      element("div", { class: "ring-words" }, this.#large, this.#small),
    );
    this.element.prepend(picture);
  }

  set(share: number, large: string, small: string): void {
    this.#arc.setAttribute("stroke-dashoffset", String(LENGTH * (1 - share)));
    this.element.setAttribute("aria-valuenow", String(Math.round(100 * share)));
    setText(this.#large, large);
    setText(this.#small, small);
  }
}
