// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { describe, expect, it } from "vitest";
import { emptyGrid, type GridFrame } from "../../messages/grids";
import { highestOf } from "./feeds";
import { HeldValues } from "./held_values";
import { endThatHolds, PRESSURE, QUANTITIES, taxelAreaM2 } from "./quantities";
import { SteppedEnd } from "./stepped_end";

function frame(stampS: number, values: number[], statuses: number[] = values.map(() => 0)): GridFrame {
  return {
    ...emptyGrid(),
    stampS,
    rows: 1,
    cols: values.length,
    values: Float32Array.from(values),
    statuses: Uint8Array.from(statuses),
  };
}

const ENDS = [1, 2, 5, 10];

describe("a scale in steps", () => {
  it("rises as soon as a value is beyond it, by whole steps", () => {
    const scale = new SteppedEnd();
    expect(scale.see(1.5, 0, ENDS)).toBe(true);
    expect(scale.value).toBe(2);
    expect(scale.see(1.9, 0.1, ENDS)).toBe(false);
    expect(scale.see(7, 0.2, ENDS)).toBe(true);
    expect(scale.value).toBe(10);
    expect(scale.see(70, 0.3, ENDS)).toBe(false);
  });

  it("falls only after seconds in which nothing came near its end", () => {
    const scale = new SteppedEnd();
    for (const [highest, stampS] of [
      [7, 0],
      [0.5, 1],
      [0.5, 5.1],
    ] as const)
      scale.see(highest, stampS, ENDS);
    expect(scale.value).toBe(10);
    for (const stampS of [6, 8, 10]) expect(scale.see(0.5, stampS, ENDS)).toBe(false);
    expect(scale.see(0.5, 10.2, ENDS)).toBe(true);
    expect(scale.value).toBe(1);
  });

  it("is fitted at once where a recording was rewound", () => {
    const scale = new SteppedEnd();
    scale.see(7, 100, ENDS);
    scale.see(0.5, 20, ENDS);
    scale.see(0.5, 26, ENDS);
    expect(scale.value).toBe(1);
  });
});

describe("held values", () => {
  it("keep the highest of each taxel until they are reset, and take any number for one that is none", () => {
    const held = new HeldValues();
    for (const values of [
      [1, NaN],
      [3, 2],
      [2, NaN],
    ])
      held.add(frame(0, values), "highest");
    expect([...held.values]).toEqual([3, 2]);
    held.reset();
    held.add(frame(1, [0, 1]), "highest");
    expect([...held.values]).toEqual([0, 1]);
  });

  it("average over about a second, whatever the rate of the frames", () => {
    for (const stepS of [0.005, 0.02]) {
      const held = new HeldValues();
      held.add(frame(0, [0]), "average");
      for (let step = 1; step * stepS <= 1.0001; ++step) held.add(frame(step * stepS, [10]), "average");
      expect(held.values[0]).toBeCloseTo(10 * (1 - Math.exp(-1)), 3);
    }
  });

  it("do not change the frame that they are of", () => {
    const held = new HeldValues();
    const first = frame(0, [1]);
    held.add(first, "highest");
    held.add(frame(1, [5]), "highest");
    expect(first.values[0]).toBe(1);
  });
});

describe("quantities", () => {
  const array = { pitch_m: [0.01, 0.02], taxel_area_m2: null } as Parameters<typeof taxelAreaM2>[0];

  it("know the area of a taxel as the pressures of contacts do", () => {
    expect(taxelAreaM2(array)).toBeCloseTo(0.25 * Math.PI * 0.007 ** 2, 9);
    expect(taxelAreaM2({ ...array, taxel_area_m2: 4e-5 })).toBe(4e-5);
  });

  it("begin the scale of pressures where ten newtons have their place", () => {
    expect(QUANTITIES[PRESSURE]!.firstEnd({ ...array, taxel_area_m2: 4e-5 })).toBe(5e5);
    expect(QUANTITIES[PRESSURE]!.label(5e5, 5e5)).toBe("500");
  });

  it("rise with their ends, of which the last holds what none does", () => {
    for (const { ends } of QUANTITIES) {
      const all = ends({ ...array, full_scale_counts: 4095 });
      expect(all).toEqual([...all].sort((a, b) => a - b));
      expect(endThatHolds(1e12, all)).toBe(all.at(-1));
    }
  });

  it("have no highest value on faulty taxels", () => {
    expect(highestOf(frame(0, [1, 9, NaN], [0, 3, 0]))).toBe(1);
  });
});
