// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import * as three from "three";
import { ConvexGeometry } from "three/addons/geometries/ConvexGeometry.js";
import type { ArrayDescription, SuitDescription } from "../../suit";

/** Distance of the hull below its taxels, and thickness of an otherwise flat hull, as shares of the suit's size. */
const BELOW_SHARE = 0.006;
const THICK_SHARE = 0.02;
/** Normals of an array that point together: it has a front. */
const ONE_WAY = 0.7;
/** Two arrays are two sides of one part of a body within so many of their own sizes. */
const NEAR = 1.5;

/** An array as a piece of a surface. */
interface Piece {
  array: ArrayDescription;
  middle: three.Vector3;
  /** Mean of the normals: short where they point all round. */
  facing: three.Vector3;
  size: number;
}

function pieceOf(array: ArrayDescription): Piece {
  const point = new three.Vector3();
  const box = new three.Box3();
  const facing = new three.Vector3();
  for (const position of array.positions) box.expandByPoint(point.fromArray(position));
  for (const normal of array.normals) facing.add(point.fromArray(normal));
  facing.divideScalar(Math.max(1, array.normals.length));
  return { array, middle: box.getCenter(new three.Vector3()), facing, size: box.getSize(point).length() };
}

/** Each lies behind the other, and not far: chest and back. */
function areTwoSides(a: Piece, b: Piece): boolean {
  if (a.facing.length() < ONE_WAY || b.facing.length() < ONE_WAY || a.array.link !== b.array.link) return false;
  const way = b.middle.clone().sub(a.middle);
  const isBehind = way.dot(a.facing) < 0 && way.dot(b.facing) > 0;
  return isBehind && a.facing.dot(b.facing) < -0.5 && way.length() < NEAR * Math.max(a.size, b.size);
}

/** The convex hull of what is a little below these taxels. */
function hull(pieces: readonly Piece[], suitSize: number): three.BufferGeometry {
  const points: three.Vector3[] = [];
  for (const { array } of pieces) {
    array.positions.forEach((position, taxel) => {
      const inwards = new three.Vector3().fromArray(array.normals[taxel]!).negate();
      for (const depth of [BELOW_SHARE, BELOW_SHARE + THICK_SHARE]) {
        points.push(new three.Vector3().fromArray(position).addScaledVector(inwards, depth * suitSize));
      }
    });
  }
  return new ConvexGeometry(points);
}

/** A plain body for a suit without one: the hull of each array, and of arrays that are two sides of one part. The groups
 *  are in the order of the arrays; of two sides the second is empty. */
export function mannequinOf({ arrays }: SuitDescription, suitSize: number, ink: three.Material): three.Group {
  const all = new three.Group();
  const pieces = arrays.map(pieceOf);
  const taken = new Set<Piece>();
  for (const piece of pieces) {
    const group = new three.Group();
    all.add(group);
    if (taken.has(piece)) continue;
    const other = pieces.find(
      (candidate) => candidate !== piece && !taken.has(candidate) && areTwoSides(piece, candidate),
    );
    const sides = other === undefined ? [piece] : [piece, other];
    for (const side of sides) taken.add(side);
    group.add(new three.Mesh(hull(sides, suitSize), ink));
  }
  return all;
}
