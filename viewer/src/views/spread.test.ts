// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { expect, test } from "vitest";
import { spread } from "./spread";

const labels = (...tops: number[]): { top: number; height: number }[] => tops.map((top) => ({ top, height: 18 }));

test("labels stand where they belong while nothing is in their way", () => {
  expect(spread(labels(100, 20), 0, 300)).toEqual(labels(20, 100));
});

test("labels of one place do not overlap, and all are inside the column", () => {
  const placed = spread(labels(290, 290, 285, 5, -10), 0, 300);
  expect(placed).toHaveLength(5);
  placed.forEach(({ top }, index) => {
    expect(top).toBeGreaterThanOrEqual(index === 0 ? 0 : placed[index - 1]!.top + 18);
    expect(top + 18).toBeLessThanOrEqual(300);
  });
});

test("labels for which there is no room are left out, the lowest first", () => {
  expect(spread(labels(0, 10, 20, 30), 0, 40)).toEqual(labels(0, 18));
});
