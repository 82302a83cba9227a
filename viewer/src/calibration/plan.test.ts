// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { describe, expect, it } from "vitest";
import type { ArrayDescription } from "../suit";
import { describeWork, inGrams, questionOn, readWeights, strideOf, taxelsOf } from "./plan";

const array = (rows: number, cols: number): ArrayDescription => ({ rows, cols }) as ArrayDescription;

describe("a plan", () => {
  it("reads weights as people write them", () => {
    expect(readWeights("1, 2.5;5  10")).toEqual({ newtons: [1, 2.5, 5, 10], taken: "" });
    for (const text of [
      "",
      "a",
      "1, x",
      "1 lb",
      "1, 1",
      "0",
      "-2",
      "1e4",
      Array.from({ length: 17 }, (_, k) => k + 1).join(" "),
    ]) {
      expect(readWeights(text), text).toBeUndefined();
    }
  });

  it("takes grams, kilograms and kPa, and says for what", () => {
    const square = { ...array(2, 2), pitch_m: [0.01, 0.01], taxel_area_m2: null } as ArrayDescription;
    for (const text of ["100 g, 500 g", "100 g, 500", "100, 500g"]) {
      expect(readWeights(text), text).toEqual({
        newtons: [expect.closeTo(0.980665), expect.closeTo(4.903325)],
        taken: "100 g, 500 g, taken for 0.9807, 4.903 N",
      });
    }
    expect(readWeights("500 g, 2 kg")?.newtons[1]).toBeCloseTo(19.6133);
    expect(readWeights("20 kPa", square)?.newtons[0]).toBeCloseTo(2);
    expect(readWeights("20 kPa")).toBeUndefined();
  });

  it("asks about a weight that no taxel bears", () => {
    const square = { ...array(2, 2), pitch_m: [0.01, 0.01], taxel_area_m2: null } as ArrayDescription;
    expect(questionOn([1, 500], square)).toBe("500 N on a taxel of 1 cm² is 5.0 MPa. Is it 500 g?");
    expect(questionOn([1, 100], square)).toBe("");
  });

  it("chooses the taxels that the server presses", () => {
    expect(strideOf("some", array(16, 16))).toBe(4);
    expect(taxelsOf("some", array(16, 16))).toHaveLength(16);
    expect(taxelsOf("some", array(16, 16)).slice(0, 5)).toEqual([17, 21, 25, 29, 81]);
    expect(taxelsOf("some", array(2, 2))).toEqual([0, 1, 2, 3]);
    expect(taxelsOf("2", array(7, 4))).toEqual([0, 2, 8, 10, 16, 18, 24, 26]);
    expect(taxelsOf("1", array(7, 5))).toHaveLength(35);
  });

  it("tells the work and the mass of a weight", () => {
    expect(describeWork(80)).toBe("80 presses, about 5 min");
    expect(describeWork(3000)).toBe("3000 presses, about 3.3 h");
    expect(inGrams(5)).toBe("510 g");
    expect(inGrams(20)).toBe("2.04 kg");
  });
});
