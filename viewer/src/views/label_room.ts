// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

/** A label by its middle and its size, in CSS pixels. */
export interface LabelBox {
  x: number;
  y: number;
  width: number;
  height: number;
}

/** By its middle, in CSS pixels. */
interface Circle {
  x: number;
  y: number;
  radius: number;
}

const GAP = 2;
/** Where a label is tried, in its own widths and heights from where it belongs: the nearest first. */
const STEPS: readonly (readonly [number, number])[] = [
  [0, 0],
  [0, -1],
  [0, 1],
  [-0.6, 0],
  [0.6, 0],
  [0, -2],
  [0, 2],
  [-0.6, -1],
  [0.6, -1],
  [-0.6, 1],
  [0.6, 1],
  [0, -3],
  [0, 3],
  [-1.1, 0],
  [1.1, 0],
  [0, -4],
  [0, 4],
  [-1.1, -2],
  [1.1, -2],
  [-1.1, 2],
  [1.1, 2],
];

function overlap(a: LabelBox, b: LabelBox): boolean {
  return (
    Math.abs(a.x - b.x) < 0.5 * (a.width + b.width) + GAP && Math.abs(a.y - b.y) < 0.5 * (a.height + b.height) + GAP
  );
}

function meets({ x, y, width, height }: LabelBox, circle: Circle): boolean {
  const right = Math.max(0, Math.abs(x - circle.x) - 0.5 * width);
  const down = Math.max(0, Math.abs(y - circle.y) - 0.5 * height);
  return Math.hypot(right, down) < circle.radius + GAP;
}

/** Gives each label a place in the picture that no other label takes. */
export class LabelRoom {
  readonly #taken: LabelBox[] = [];
  readonly #avoided: Circle[] = [];

  constructor(
    readonly width: number,
    readonly height: number,
  ) {}

  /** Something else is here already. */
  take(box: LabelBox): void {
    this.#taken.push(box);
  }

  /** Labels stand outside of this while there is room for them. */
  avoid(circle: Circle): void {
    this.#avoided.push(circle);
  }

  /** The nearest free place inside the picture, which is taken from now on; undefined: there is none near enough. */
  place(wanted: LabelBox): LabelBox | undefined {
    return this.#placeOutside(wanted, this.#avoided) ?? this.#placeOutside(wanted, []);
  }

  #placeOutside(wanted: LabelBox, circles: readonly Circle[]): LabelBox | undefined {
    for (const [right, down] of STEPS) {
      const box = this.#inside({
        ...wanted,
        x: wanted.x + right * (wanted.width + GAP),
        y: wanted.y + down * (wanted.height + GAP),
      });
      if (this.#taken.some((other) => overlap(box, other)) || circles.some((circle) => meets(box, circle))) continue;
      this.#taken.push(box);
      return box;
    }
    return undefined;
  }

  #inside(box: LabelBox): LabelBox {
    const clamp = (value: number, half: number, end: number): number =>
      Math.max(half + GAP, Math.min(end - half - GAP, value));
    return { ...box, x: clamp(box.x, 0.5 * box.width, this.width), y: clamp(box.y, 0.5 * box.height, this.height) };
  }
}
