// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { describe, expect, it } from "vitest";
import { highest, roundEnd } from "./frame_picture";

describe("the end of a scale", () => {
  it("is the next of 1, 2, 5, 10, ...", () => {
    expect([0.013, 0.2, 0.21, 1, 3, 5, 7.5, 1234].map(roundEnd)).toEqual([0.02, 0.2, 0.5, 1, 5, 5, 10, 2000]);
    expect([0, -1, NaN, Infinity].map(roundEnd)).toEqual([1, 1, 1, 1]);
  });

  it("knows no taxel without a value", () => {
    const frame = {
      stampS: 0,
      rows: 1,
      cols: 4,
      values: Float32Array.of(1, 9, NaN, 2),
      sigmas: new Float32Array(4),
      statuses: Uint8Array.of(0, 3, 0, 1),
    };
    expect(highest(frame)).toBe(2);
  });
});
