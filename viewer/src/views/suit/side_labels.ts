// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { setData, setHidden } from "../../dom";
import { type Standing, spread } from "../spread";

/** Width of the columns at both sides of the suit, which the suit leaves free, in a picture of this width. */
export function columnPx(width: number): number {
  return Math.min(150, 0.27 * width);
}

const EDGE_PX = 8;
const GAP_PX = 3;
/** Below the columns stand the scale of the arrows and the axes. */
const FOOT_PX = 84;
const SVG = "http://www.w3.org/2000/svg";

/** A label and the place that it tells of; undefined: that cannot be seen. */
export interface Told {
  readonly label: HTMLElement;
  readonly at: readonly [number, number] | undefined;
}

interface Placed extends Told, Standing {
  readonly at: readonly [number, number];
}

/** Labels in two columns beside the suit, each with a line to its place. */
export class SideLabels {
  readonly lines = document.createElementNS(SVG, "svg");

  constructor() {
    this.lines.setAttribute("class", "leaders");
    this.lines.setAttribute("aria-hidden", "true");
  }

  place(told: readonly Told[], width: number, height: number): void {
    for (const { label, at } of told) setHidden(label, at === undefined);
    const all = told.flatMap(({ label, at }): Placed[] => {
      if (at === undefined) return [];
      const high = label.offsetHeight + GAP_PX;
      return [{ label, at, height: high, top: at[1] - 0.5 * high }];
    });
    const leads = [true, false].flatMap((isLeft) => {
      const side = all.filter(({ at }) => at[0] < 0.5 * width === isLeft);
      const placed = spread(side, EDGE_PX, height - FOOT_PX);
      for (const one of side) if (!placed.includes(one)) setHidden(one.label, true);
      return placed.map((one) => this.#put(one, isLeft, width));
    });
    this.lines.replaceChildren(...leads);
  }

  #put({ label, at, top, height }: Placed, isLeft: boolean, width: number): SVGPolylineElement {
    const left = isLeft ? EDGE_PX : width - EDGE_PX - label.offsetWidth;
    label.style.transform = `translate(${left.toFixed(1)}px, ${top.toFixed(1)}px)`;
    setData(label, "at", at.map((place) => place.toFixed(1)).join(" "));
    const middle = top + 0.5 * (height - GAP_PX);
    const [from, bend] = isLeft ? [left + label.offsetWidth, columnPx(width)] : [left, width - columnPx(width)];
    const line = document.createElementNS(SVG, "polyline");
    line.setAttribute("points", `${from},${middle} ${bend},${middle} ${at[0]},${at[1]}`);
    line.setAttribute("class", `${label.className.split(" ")[0]}-line`);
    return line;
  }
}
