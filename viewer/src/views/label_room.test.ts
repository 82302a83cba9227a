// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { expect, test } from "vitest";
import { type LabelBox, LabelRoom } from "./label_room";

const label = (x: number, y: number): LabelBox => ({ x, y, width: 60, height: 16 });

test("a label stands where it belongs while nothing is in its way", () => {
  const room = new LabelRoom(400, 300);
  expect(room.place(label(200, 100))).toEqual(label(200, 100));
  expect(room.place(label(200, 200))).toEqual(label(200, 200));
});

test("labels of one place do not overlap, and all are inside the picture", () => {
  const room = new LabelRoom(400, 300);
  const placed = Array.from({ length: 12 }, () => room.place(label(395, 2))).filter((box) => box !== undefined);
  expect(placed.length).toBeGreaterThan(3);
  for (const [index, box] of placed.entries()) {
    expect(box.x - 30).toBeGreaterThanOrEqual(0);
    expect(box.x + 30).toBeLessThanOrEqual(400);
    expect(box.y - 8).toBeGreaterThanOrEqual(0);
    for (const other of placed.slice(index + 1)) {
      expect(Math.abs(box.x - other.x) >= 60 || Math.abs(box.y - other.y) >= 16).toBe(true);
    }
  }
});

test("a label without a free place nearby is left out", () => {
  const room = new LabelRoom(100, 40);
  const placed = Array.from({ length: 9 }, () => room.place(label(50, 20)));
  expect(placed.at(-1)).toBeUndefined();
});

test("a label stands outside of a circle, and on it only where there is no other place", () => {
  const room = new LabelRoom(400, 300);
  room.avoid({ x: 200, y: 100, radius: 20 });
  const beside = room.place(label(200, 100))!;
  expect(Math.max(Math.abs(beside.x - 200) - 30, Math.abs(beside.y - 100) - 8)).toBeGreaterThanOrEqual(20);
  const full = new LabelRoom(100, 60);
  full.avoid({ x: 50, y: 30, radius: 200 });
  expect(full.place(label(50, 30))).toEqual(label(50, 30));
});
