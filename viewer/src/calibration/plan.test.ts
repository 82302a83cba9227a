// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { describe, expect, it } from "vitest";
import type { ArrayDescription } from "../suit";
import { describeWork, inGrams, readWeights, strideOf, taxelsOf } from "./plan";

const array = (rows: number, cols: number): ArrayDescription => ({ rows, cols }) as ArrayDescription;

describe("a plan", () => {
  it("reads weights as people write them", () => {
    expect(readWeights("1, 2.5;5  10")).toEqual([1, 2.5, 5, 10]);
    for (const text of ["", "a", "1, 1", "0", "-2", "1e4", Array.from({ length: 17 }, (_, k) => k + 1).join(" ")]) {
      expect(readWeights(text), text).toBeUndefined();
    }
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
