// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { expect, it } from "vitest";
import type { ArrayDescription, SuitDescription } from "../../suit";
import { asOnMap, isLoneAndFlat } from "./as_on_map";

const flat = {
  pose: { position: [0, 0, 0], rotation: [0, 0, 0, 1] },
  positions: [
    [0, 0, 0],
    [0, 0.01, 0],
  ],
  normals: [
    [0, 0, 1],
    [0, 0, 1],
  ],
} as unknown as ArrayDescription;
const suit = (...arrays: ArrayDescription[]): SuitDescription => ({ name: "", arrays });

it("turns a lone flat array so that its rows go down, as on its map", () => {
  expect(isLoneAndFlat(suit(flat))).toBe(true);
  expect(asOnMap(suit(flat)).arrays[0]!.positions[1]).toEqual([0, -0.01, 0]);
});

it("leaves arrays as they are that somebody has put in their place", () => {
  expect(isLoneAndFlat(suit(flat, flat))).toBe(false);
  expect(isLoneAndFlat(suit({ ...flat, pose: { position: [0, 0, 0], rotation: [1, 0, 0, 0] } }))).toBe(false);
  expect(
    isLoneAndFlat(
      suit({
        ...flat,
        normals: [
          [1, 0, 0],
          [0, 0, 1],
        ],
      }),
    ),
  ).toBe(false);
});
