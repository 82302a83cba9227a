// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import * as three from "three";

/** A place is seen where its normal points so much towards the eye: the cosine of the angle between them. */
const SEEN_COSINE = 0.3;
/** So long it looks one way before it turns again, and so quickly it turns. */
const REST_MS = 2500;
const TURN_RATE = 2.5;
const ARRIVED = 0.01;

/** Where a touch presses, and how strongly. */
export interface Pressed {
  readonly normal: three.Vector3;
  readonly forceN: number;
}

/** Turns the look at a suit so that what is touched is seen: round the upright axis alone. */
export class Heading {
  #goal: three.Vector3 | undefined;
  #turnedMs = -Infinity;
  #lastMs = 0;

  stop(): void {
    this.#goal = undefined;
  }

  /** `direction`: from the suit to the eye. */
  see(pressed: readonly Pressed[], direction: three.Vector3, up: three.Vector3, nowMs: number): void {
    if (this.#goal !== undefined || nowMs - this.#turnedMs < REST_MS) return;
    if (pressed.every(({ normal }) => normal.dot(direction) > SEEN_COSINE)) return;
    const mean = new three.Vector3();
    for (const { normal, forceN } of pressed) mean.addScaledVector(normal, forceN);
    const strongest = pressed.reduce((one, other) => (other.forceN > one.forceN ? other : one));
    for (const wanted of [mean, strongest.normal]) {
      const flat = wanted.clone().projectOnPlane(up);
      if (flat.length() < 0.3 * wanted.length() || wanted.length() === 0) continue;
      const goal = flat.normalize();
      if (goal.dot(strongest.normal) < SEEN_COSINE) continue;
      const isThere = goal.angleTo(direction.clone().projectOnPlane(up)) < 0.2;
      this.#goal = isThere ? undefined : goal;
      this.#lastMs = nowMs;
      return;
    }
  }

  /** The direction some milliseconds later; undefined: it stays. */
  step(direction: three.Vector3, up: three.Vector3, nowMs: number): three.Vector3 | undefined {
    const goal = this.#goal;
    if (goal === undefined) return undefined;
    const flat = direction.clone().projectOnPlane(up);
    const angle = Math.atan2(new three.Vector3().crossVectors(flat, goal).dot(up), flat.dot(goal));
    const share = 1 - Math.exp((-TURN_RATE * (nowMs - this.#lastMs)) / 1000);
    this.#lastMs = nowMs;
    const isEnd = Math.abs(angle) * (1 - share) < ARRIVED;
    if (isEnd) {
      this.#goal = undefined;
      this.#turnedMs = nowMs;
    }
    return direction.clone().applyAxisAngle(up, isEnd ? angle : share * angle);
  }
}
