// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import * as three from "three";
import type { Contact } from "../../messages/contacts";

export const MOST_ARROWS = 64;
/** Length of an arrow at the end of the scale, as a share of the suit's size. */
export const LONGEST_SHARE = 0.2;
const HEAD_SHARE = 0.025;
const DOWN = new three.Vector3(0, -1, 0);

/** Arrows that press on the suit where it is touched, as long as their forces. One beyond the scale has a second head. */
export class ContactArrows {
  readonly group = new three.Group();
  readonly #material = new three.MeshBasicMaterial();
  readonly #shaft = new three.CylinderGeometry(1, 1, 1, 12, 1);
  readonly #head = new three.ConeGeometry(1, 1, 16, 1);
  readonly #arrows: three.Group[] = [];
  readonly #direction = new three.Vector3();
  #used = 0;

  constructor() {
    this.#shaft.translate(0, 0.5, 0);
    this.#head.rotateX(Math.PI).translate(0, 0.5, 0);
  }

  setColor(color: string): void {
    this.#material.color.set(color);
  }

  begin(): void {
    this.#used = 0;
  }

  /** `isYTurned`: as asOnMap() has it. Writes where the arrow begins to `tail`; false: there are too many. */
  add(
    { position, normal, forceN }: Contact,
    isYTurned: boolean,
    scaleEnd: number,
    size: number,
    tail: three.Vector3,
  ): boolean {
    if (this.#used === MOST_ARROWS) return false;
    const arrow = this.#arrows[this.#used] ?? this.#make();
    this.#used += 1;
    arrow.visible = true;
    const sign = isYTurned ? -1 : 1;
    arrow.position.set(position[0]!, sign * position[1]!, position[2]!);
    this.#direction.set(-normal[0]!, -sign * normal[1]!, -normal[2]!);
    arrow.quaternion.setFromUnitVectors(DOWN, this.#direction);
    const length = size * LONGEST_SHARE * Math.min(1, forceN / scaleEnd);
    const [shaft, head, second] = arrow.children as [three.Mesh, three.Mesh, three.Mesh];
    const headLength = Math.min(HEAD_SHARE * size, length);
    for (const each of [head, second]) each.scale.set(0.32 * headLength, headLength, 0.32 * headLength);
    second.visible = forceN > scaleEnd;
    second.position.y = headLength;
    shaft.position.y = headLength;
    shaft.scale.set(0.0022 * size, Math.max(1e-6, length - headLength), 0.0022 * size);
    tail.copy(arrow.position).addScaledVector(this.#direction, -length);
    return true;
  }

  end(): void {
    for (let index = this.#used; index < this.#arrows.length; ++index) this.#arrows[index]!.visible = false;
  }

  #make(): three.Group {
    const arrow = new three.Group();
    arrow.add(...[this.#shaft, this.#head, this.#head].map((geometry) => new three.Mesh(geometry, this.#material)));
    this.#arrows.push(arrow);
    this.group.add(arrow);
    return arrow;
  }
}
