// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { describe, expect, it } from "vitest";
import { cornerOf, describeWayRound, sentPlace, wayRound } from "./corners";

const ROWS = 12;
const COLS = 10;
const SHAPE = { rows: ROWS, cols: COLS };

describe("two corners", () => {
  it("tell every way round in which lines can be sent", () => {
    for (let bits = 0; bits < 8; bits += 1) {
      const way = { transpose: (bits & 1) !== 0, flip_rows: (bits & 2) !== 0, flip_cols: (bits & 4) !== 0 };
      expect(wayRound(sentPlace([0, 0], SHAPE, way), sentPlace([0, COLS - 1], SHAPE, way))).toEqual(way);
    }
  });

  it("tell nothing where they are opposite, or one", () => {
    expect(wayRound([0, 0], [11, 9])).toBeUndefined();
    expect(wayRound([0, 9], [11, 0])).toBeUndefined();
    expect(wayRound([11, 0], [11, 0])).toBeUndefined();
  });
});

describe("a touch", () => {
  it("means the corner that is near", () => {
    expect(cornerOf([0, 0], ROWS, COLS)).toEqual([0, 0]);
    expect(cornerOf([2, 7], ROWS, COLS)).toEqual([0, 9]);
    expect(cornerOf([9, 2], ROWS, COLS)).toEqual([11, 0]);
    expect(cornerOf([1, 1], 2, 2)).toEqual([1, 1]);
  });

  it("means none where none is near", () => {
    expect(cornerOf([3, 0], ROWS, COLS)).toBeUndefined();
    expect(cornerOf([0, 4], ROWS, COLS)).toBeUndefined();
    expect(cornerOf([1, 0], 3, 3)).toBeUndefined();
  });
});

describe("a way round", () => {
  it("is told in words", () => {
    expect(describeWayRound({ transpose: false, flip_rows: false, flip_cols: false })).toBe(
      "The lines are sent as they are.",
    );
    expect(describeWayRound({ transpose: true, flip_rows: true, flip_cols: false })).toBe(
      "The lines are turned: rows and columns are exchanged, the last row comes first.",
    );
  });
});
