// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import * as three from "three";
import { shaderSource } from "../../render/color_map";
import type { Rgb } from "../../render/heat_maps";
import type { SuitDescription } from "../../suit";

const FILL = 0.86;

const VERTEX = `
in vec3 place;
in vec3 facing;
in float radius;
in float newtons;
in float status;
in float chosen;
in float disc;
out float force;
out float fault;
out float marked;
out float rounded;
out vec2 inside;
out float shade;

void main() {
  vec3 side = normalize(abs(facing.z) < 0.9 ? cross(vec3(0.0, 0.0, 1.0), facing) : cross(vec3(1.0, 0.0, 0.0), facing));
  vec3 up = cross(facing, side);
  inside = position.xy;
  force = newtons;
  fault = status;
  marked = chosen;
  rounded = disc;
  vec4 seen = modelViewMatrix * vec4(place + radius * (side * position.x + up * position.y), 1.0);
  vec3 normal_seen = normalMatrix * facing;
  float turned = dot(normalize(normal_seen), normalize(-seen.xyz));
  shade = turned > 0.0 ? 1.0 : 0.45;
  gl_Position = projectionMatrix * seen;
}`;

const FRAGMENT = `
precision highp float;
uniform float scale_end;
uniform vec3 fault_color;
uniform vec3 stripe_color;
uniform vec3 chosen_color;
uniform vec3 rim_color;
in float force;
in float fault;
in float marked;
in float rounded;
in vec2 inside;
in float shade;
out vec4 color;

${shaderSource()}

void main() {
  float from_middle = rounded > 0.5 ? length(inside) : max(abs(inside.x), abs(inside.y));
  if (from_middle > 1.0) discard;
  bool crossed = min(abs(inside.x - inside.y), abs(inside.x + inside.y)) < 0.3;
  vec3 taxel = fault > 2.5 ? (crossed ? stripe_color : fault_color) : color_map(force / scale_end);
  if (fault < 2.5 && force > scale_end && length(inside) < 0.24) taxel = vec3(opposite(taxel));
  bool on_rim = from_middle > 0.88;
  vec3 rim = marked > 0.5 ? chosen_color : rim_color;
  color = vec4((on_rim ? mix(taxel, rim, 0.6) : taxel) * shade, 1.0);
}`;

/** Metres to the next taxel. */
export function nearestNeighbour(positions: readonly [number, number, number][], cols: number): number {
  const [first, second, below] = [positions[0]!, positions[1], positions[cols]];
  const distance = (to: readonly number[] | undefined): number =>
    to === undefined ? Infinity : Math.hypot(to[0]! - first[0], to[1]! - first[1], to[2]! - first[2]);
  const nearest = Math.min(cols > 1 ? distance(second) : Infinity, distance(below));
  return Number.isFinite(nearest) && nearest > 0 ? nearest : 0.01;
}

/** All taxels of the suit in one draw: a quad each, facing along its normal, coloured by its force. */
export class TaxelCloud {
  readonly mesh: three.Mesh<three.InstancedBufferGeometry, three.RawShaderMaterial>;
  readonly #newtons: three.InstancedBufferAttribute;
  readonly #statuses: three.InstancedBufferAttribute;
  readonly #chosen: three.InstancedBufferAttribute;
  readonly #firsts: number[] = [];
  readonly #places: three.InstancedBufferAttribute;
  readonly #facings: three.InstancedBufferAttribute;
  readonly #suit: SuitDescription;

  constructor(suit: SuitDescription) {
    this.#suit = suit;
    const { arrays } = suit;
    const total = arrays.reduce((sum, { positions }) => sum + positions.length, 0);
    const places = new Float32Array(3 * total);
    const facings = new Float32Array(3 * total);
    const radii = new Float32Array(total);
    const rounded = new Float32Array(total);
    let taxel = 0;
    for (const { positions, normals, cols, places: discs } of arrays) {
      this.#firsts.push(taxel);
      const radius = 0.5 * FILL * nearestNeighbour(positions, cols);
      positions.forEach((position, index) => {
        places.set(position, 3 * taxel);
        facings.set(normals[index]!, 3 * taxel);
        rounded[taxel] = discs === undefined ? 0 : 1;
        radii[taxel] = discs?.[index]?.[2] ?? radius;
        taxel += 1;
      });
    }
    this.#firsts.push(taxel);
    const dynamic = (): three.InstancedBufferAttribute => {
      const attribute = new three.InstancedBufferAttribute(new Float32Array(total), 1);
      return attribute.setUsage(three.DynamicDrawUsage);
    };
    [this.#newtons, this.#statuses, this.#chosen] = [dynamic(), dynamic(), dynamic()];
    const geometry = new three.InstancedBufferGeometry();
    geometry.instanceCount = total;
    geometry.setAttribute(
      "position",
      new three.BufferAttribute(new Float32Array([-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0]), 3),
    );
    geometry.setIndex([0, 1, 2, 0, 2, 3]);
    this.#places = new three.InstancedBufferAttribute(places, 3);
    this.#facings = new three.InstancedBufferAttribute(facings, 3);
    geometry.setAttribute("place", this.#places);
    geometry.setAttribute("facing", this.#facings);
    geometry.setAttribute("radius", new three.InstancedBufferAttribute(radii, 1));
    geometry.setAttribute("disc", new three.InstancedBufferAttribute(rounded, 1));
    geometry.setAttribute("newtons", this.#newtons);
    geometry.setAttribute("status", this.#statuses);
    geometry.setAttribute("chosen", this.#chosen);
    this.mesh = new three.Mesh(geometry, this.#material());
    this.mesh.frustumCulled = false;
  }

  #material(): three.RawShaderMaterial {
    const header =
      "precision highp float;\nuniform mat4 modelViewMatrix;\nuniform mat4 projectionMatrix;\nuniform mat3 normalMatrix;\nin vec3 position;\n";
    return new three.RawShaderMaterial({
      glslVersion: three.GLSL3,
      vertexShader: header + VERTEX,
      fragmentShader: FRAGMENT,
      side: three.DoubleSide,
      uniforms: {
        scale_end: { value: 10 },
        fault_color: { value: new three.Vector3() },
        stripe_color: { value: new three.Vector3() },
        chosen_color: { value: new three.Vector3() },
        rim_color: { value: new three.Vector3() },
        from_light: { value: false },
      },
    });
  }

  setColors(fault: Rgb, stripe: Rgb, chosen: Rgb, rim: Rgb, fromLight: boolean): void {
    const { uniforms } = this.mesh.material;
    uniforms.fault_color!.value.set(...fault);
    uniforms.stripe_color!.value.set(...stripe);
    uniforms.chosen_color!.value.set(...chosen);
    uniforms.rim_color!.value.set(...rim);
    uniforms.from_light!.value = fromLight;
  }

  /** `move`: of an array, from where /suit.json has it. */
  move(array: number, move: three.Matrix4): void {
    const { positions, normals } = this.#suit.arrays[array]!;
    const point = new three.Vector3();
    const first = this.#firsts[array]!;
    positions.forEach((position, taxel) =>
      point
        .fromArray(position)
        .applyMatrix4(move)
        .toArray(this.#places.array, 3 * (first + taxel)),
    );
    normals.forEach((normal, taxel) =>
      point
        .fromArray(normal)
        .transformDirection(move)
        .toArray(this.#facings.array, 3 * (first + taxel)),
    );
    this.#places.needsUpdate = true;
    this.#facings.needsUpdate = true;
  }

  setScale(end: number): void {
    this.mesh.material.uniforms.scale_end!.value = end;
  }

  choose(array: number): void {
    const chosen = this.#chosen.array as Float32Array;
    chosen.fill(0);
    if (array >= 0) chosen.fill(1, this.#firsts[array]!, this.#firsts[array + 1]!);
    this.#chosen.needsUpdate = true;
  }

  setForces(newtons: Float32Array, statuses: Uint8Array): void {
    const values = this.#newtons.array as Float32Array;
    if (newtons.length !== values.length) return;
    values.set(newtons);
    (this.#statuses.array as Float32Array).set(statuses);
    this.#newtons.needsUpdate = true;
    this.#statuses.needsUpdate = true;
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }
}
