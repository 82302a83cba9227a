// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { describe, expect, it } from "vitest";
import { doubtsOf, gridMarks, millimetresOf, type Pressed, taskOf } from "./pressed_places";

const PRESSED: Pressed = {
  ready: true,
  place: 2,
  done: false,
  pressed: false,
  repeated: null,
  channels: [7, 3, null, null],
  problem: "",
};

describe("places of a grid", () => {
  it("are the middles of its cells, row by row", () => {
    expect(gridMarks({ rows: 2, cols: 2 })).toEqual([
      [0.25, 0.25],
      [0.75, 0.25],
      [0.25, 0.75],
      [0.75, 0.75],
    ]);
  });
});

describe("marks on a picture", () => {
  it("are in millimetres by the distance of the first two", () => {
    const marks = [
      [0.1, 0.5],
      [0.3, 0.5],
      [0.1, 0.25],
    ] as const;
    expect(millimetresOf(marks, 1000, 400, 40)).toEqual([0, 20, 40, 20, 0, 0]);
  });

  it("are nowhere without a distance", () => {
    expect(millimetresOf([[0.1, 0.5]], 100, 100, 40)).toBeUndefined();
    expect(
      millimetresOf(
        [
          [0.1, 0.5],
          [0.1, 0.5],
        ],
        100,
        100,
        40,
      ),
    ).toBeUndefined();
  });
});

describe("the task", () => {
  it("names the place to press", () => {
    expect(taskOf(PRESSED)).toBe("Press place 3 of 4, and let go.");
    expect(taskOf({ ...PRESSED, ready: false })).toBe("Take your hands off for a second.");
    expect(taskOf({ ...PRESSED, done: true })).toBe("All places were pressed.");
  });

  it("says which channel answered before", () => {
    expect(taskOf({ ...PRESSED, repeated: 0 })).toMatch(/^Channel 7 answered at place 1 already\. Press place 3/);
  });
});

describe("doubts", () => {
  it("name places that never answered, and those that share a channel", () => {
    expect(doubtsOf(PRESSED)).toEqual([]);
    expect(doubtsOf({ ...PRESSED, place: 4, channels: [7, null, 7, null] })).toEqual([
      "Places 2, 4 never answered.",
      "Places 1 and 3 are both answered by channel 7.",
    ]);
  });
});
