// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { describe, expect, it } from "vitest";
import type { ArrayDescription } from "../../suit";
import { boxOf, cellOf, fitMap, pointOn, sharesOf, taxelAt } from "./geometry";

const FINGER = {
  rows: 1,
  cols: 3,
  pitch_m: [0.01, 0.01],
  places: [
    [0, 0, 0.002],
    [0.01, 0, 0.002],
    [0.01, 0.02, 0.004],
  ],
} as unknown as ArrayDescription;
const AREA = { left: 100, top: 50, width: 160, height: 260 }; // 10 pixels a millimetre, from -2 mm on

describe("taxels in no grid", () => {
  it("have a map of their proportions", () => {
    const { width, height } = fitMap({ left: 0, top: 0, width: 500, height: 500 }, FINGER);
    expect(width / height).toBeCloseTo(16 / 26, 6);
  });

  it("are found within their discs alone", () => {
    expect(taxelAt(AREA, FINGER, 125, 70)).toBe(0);
    expect(taxelAt(AREA, FINGER, 220, 270)).toBe(2);
    expect(taxelAt(AREA, FINGER, 120, 200)).toBe(-1);
  });

  it("are framed by the squares round their discs", () => {
    expect(cellOf(AREA, FINGER, 1)).toEqual({ left: 200, top: 50, width: 40, height: 40 });
    expect(boxOf(AREA, FINGER, [0, 0], [0, 1])).toEqual({ left: 100, top: 50, width: 140, height: 40 });
  });

  it("carry points between those that follow each other", () => {
    expect(pointOn(AREA, FINGER, 0.005, 0)).toEqual([170, 70]);
    expect(pointOn(AREA, FINGER, 0.5, 0)).toEqual([220, 270]);
  });

  it("are shares of the map for the drawing", () => {
    expect([...sharesOf(FINGER)].slice(0, 4).map((share) => Math.round(1000 * share))).toEqual([125, 77, 125, 77]);
  });
});
