// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import * as three from "three";
import { expect, test } from "vitest";
import { Heading, type Pressed } from "./heading";

const UP = new three.Vector3(0, 0, 1);
const FRONT = new three.Vector3(0.94, 0, 0.34).normalize();
const press = (x: number, y: number, z: number, forceN = 1): Pressed => ({
  normal: new three.Vector3(x, y, z),
  forceN,
});

/** Where the eye is after three seconds. */
function after(pressed: readonly Pressed[]): three.Vector3 {
  const heading = new Heading();
  let direction = FRONT;
  for (let ms = 0; ms < 3000; ms += 16) {
    heading.see(pressed, direction, UP, ms);
    direction = heading.step(direction, UP, ms) ?? direction;
  }
  return direction;
}

test("the eye stays while all that is touched is seen", () => {
  expect(after([press(1, 0, 0), press(0.8, 0.6, 0)])).toEqual(FRONT);
  expect(after([])).toEqual(FRONT);
});

test("the eye goes round to a back that is touched, and keeps its height", () => {
  const direction = after([press(-1, 0, 0)]);
  expect(direction.x).toBeLessThan(-0.9);
  expect(direction.z).toBeCloseTo(FRONT.z, 6);
});

test("of front and back the eye sees what is pressed harder", () => {
  expect(after([press(1, 0, 0, 1), press(-1, 0, 0, 9)]).x).toBeLessThan(-0.9);
  expect(after([press(1, 0, 0, 9), press(-1, 0, 0, 1)])).toEqual(FRONT);
});

test("a touch from above or below turns nothing", () => {
  expect(after([press(0, 0, -1)])).toEqual(FRONT);
});
