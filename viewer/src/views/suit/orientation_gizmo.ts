// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

const SVG = "http://www.w3.org/2000/svg";
const SIZE = 76;
const LENGTH = 26;
const LETTER = 33;
const AXES = [
  { name: "x", color: "var(--bad)" },
  { name: "y", color: "var(--good)" },
  { name: "z", color: "var(--accent)" },
];

interface Arm {
  group: SVGGElement;
  line: SVGLineElement;
  letter: SVGTextElement;
}

function part<K extends keyof SVGElementTagNameMap>(
  tag: K,
  attributes: Record<string, string | number>,
): SVGElementTagNameMap[K] {
  const result = document.createElementNS(SVG, tag);
  for (const [name, value] of Object.entries(attributes)) result.setAttribute(name, String(value));
  return result;
}

/** The axes of the suit's frame, as the camera sees them. */
export class OrientationGizmo {
  readonly element = part("svg", {
    class: "orientation",
    viewBox: `${-SIZE / 2} ${-SIZE / 2} ${SIZE} ${SIZE}`,
    role: "img",
    "aria-label": "The axes of the suit's frame",
  });
  readonly #arms: Arm[];

  constructor() {
    this.#arms = AXES.map(({ name, color }) => {
      const group = part("g", {});
      const line = part("line", { x1: 0, y1: 0, stroke: color, "stroke-width": 2 });
      const letter = part("text", { fill: color, "text-anchor": "middle", "dominant-baseline": "central" });
      letter.textContent = name;
      group.append(line, letter);
      this.element.append(group);
      return { group, line, letter };
    });
  }

  /** Shows where each axis points on the picture: right, up and towards the eye, of length 1. */
  show(directions: readonly (readonly [number, number, number])[]): void {
    const order = directions.map((_, index) => index).sort((a, b) => directions[a]![2] - directions[b]![2]);
    for (const index of order) {
      const [right, up, near] = directions[index]!;
      const { group, line, letter } = this.#arms[index]!;
      line.setAttribute("x2", (LENGTH * right).toFixed(1));
      line.setAttribute("y2", (-LENGTH * up).toFixed(1));
      letter.setAttribute("x", (LETTER * right).toFixed(1));
      letter.setAttribute("y", (-LETTER * up).toFixed(1));
      group.setAttribute("opacity", near < -0.2 ? "0.55" : "1");
      this.element.append(group);
    }
  }
}
