// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { element } from "../dom";

const SVG = "http://www.w3.org/2000/svg";
const WIDTH = 398;
const HEIGHT = 120;
const LEFT = 44;
const BOTTOM = 18;
const TOP = 8;
const ENDS = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5];

interface Point {
  presses: number;
  error: number;
}

function svg(name: string, attributes: Record<string, string | number>, text = ""): SVGElement {
  const result = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) result.setAttribute(key, String(value));
  result.textContent = text;
  return result;
}

/** Error of the fit on presses that it did not see, over the presses so far. */
export class QualityPlot {
  readonly element: HTMLElement;
  readonly #picture = svg("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: "img" });
  #points: Point[] = [];
  #total = 0;

  constructor() {
    this.element = element("div", { class: "quality-plot", "data-role": "quality-plot" });
    this.element.append(this.#picture);
  }

  clear(): void {
    this.#points = [];
    this.#draw();
  }

  /** Takes a value that has changed. */
  add(presses: number, total: number, error: number): void {
    if (Number.isNaN(error)) return;
    const last = this.#points.at(-1);
    if (last?.error === error && this.#total === total) return;
    if (last !== undefined && presses < last.presses)
      this.#points = this.#points.filter((point) => point.presses < presses);
    this.#points.push({ presses, error });
    this.#total = total;
    this.#draw();
  }

  #draw(): void {
    const highest = Math.max(0, ...this.#points.map(({ error }) => error));
    const end = ENDS.find((candidate) => candidate >= highest) ?? highest;
    const x = (presses: number): number => LEFT + ((WIDTH - LEFT - 8) * presses) / Math.max(1, this.#total);
    const y = (error: number): number => HEIGHT - BOTTOM - ((HEIGHT - BOTTOM - TOP) * error) / end;
    const parts: SVGElement[] = [];
    for (const error of [0, end / 2, end]) {
      parts.push(svg("line", { class: "quality-grid", x1: LEFT, x2: WIDTH - 8, y1: y(error), y2: y(error) }));
      parts.push(
        svg(
          "text",
          { class: "quality-label", x: LEFT - 6, y: y(error) + 4, "text-anchor": "end" },
          `${Number((100 * error).toPrecision(2))} %`,
        ),
      );
    }
    if (this.#total > 0) {
      parts.push(svg("text", { class: "quality-label", x: x(0), y: HEIGHT - 4 }, "0"));
      parts.push(
        svg(
          "text",
          { class: "quality-label", x: x(this.#total), y: HEIGHT - 4, "text-anchor": "end" },
          `${this.#total} presses`,
        ),
      );
    }
    const line = this.#points.map(({ presses, error }) => `${x(presses).toFixed(1)},${y(error).toFixed(1)}`).join(" ");
    parts.push(svg("polyline", { class: "quality-line", points: line }));
    for (const { presses, error } of this.#points)
      parts.push(svg("circle", { class: "quality-point", cx: x(presses), cy: y(error), r: 2.5 }));
    this.#picture.replaceChildren(...parts);
    const last = this.#points.at(-1);
    this.#picture.setAttribute(
      "aria-label",
      last === undefined ? "no figure yet" : `${(100 * last.error).toFixed(1)} % after ${last.presses} presses`,
    );
  }
}
