// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import type { SuitDescription } from "../../suit";

const UP = 0.999;

/** A lone flat array, which nobody has put anywhere: it is to look as on its map. */
export function isLoneAndFlat({ arrays: [array, ...others], body }: SuitDescription): boolean {
  if (array === undefined || others.length > 0 || body !== undefined) return false;
  return array.pose.rotation[3] > UP && array.normals.every(([, , z]) => z > UP);
}

/** Its rows go down on a map, and seen from the touched side they go up: y is turned. */
export function asOnMap(suit: SuitDescription): SuitDescription {
  const turned = ([x, y, z]: [number, number, number]): [number, number, number] => [x, -y, z];
  return {
    ...suit,
    arrays: suit.arrays.map((array) => ({
      ...array,
      positions: array.positions.map(turned),
      normals: array.normals.map(turned),
    })),
  };
}
