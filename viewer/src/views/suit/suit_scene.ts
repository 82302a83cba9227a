// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import * as three from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { type Contact, ContactPhase, type ContactsFrame } from "../../messages/contacts";
import type { PointsFrame } from "../../messages/grids";
import type { Transform } from "../../messages/transforms";
import type { PlacedPose, SuitDescription } from "../../suit";
import { cssColor, rgbColor } from "../../theme";
import { touchingIn } from "../array/picture";
import { limitedZones } from "../array/zones";
import { BodyModel, type FetchFile } from "./body_model";
import { ContactArrows, LONGEST_SHARE, MOST_ARROWS } from "./contact_arrows";
import { Heading } from "./heading";
import { mannequinOf } from "./mannequin";
import { columnPx } from "./side_labels";
import { nearestNeighbour, TaxelCloud } from "./taxel_cloud";

const TURN_STEP = 0.12;
const ZOOM_STEP = 1.15;
const CENTRINGS = 6;
/** Share of the picture's height that the suit fills, and of what the labels leave of its width. */
const FIT_SHARE = 0.92;
/** Clicks this near to a taxel mean its array, as a share of the suit's size. */
const CLICK_SHARE = 0.03;

/** Height of the lines round zones above their taxels, as a share of the suit's size. */
const LIFT_SHARE = 0.01;

/** How the server names the links of the body among its frames. */
const LINK_PREFIX = "body/";

/** A point that is to be seen, with what is round it. */
interface Reaching {
  readonly point: three.Vector3;
  readonly reach: number;
}

function matrixOf({ position, rotation }: PlacedPose): three.Matrix4 {
  const one = new three.Vector3(1, 1, 1);
  return new three.Matrix4().compose(
    new three.Vector3().fromArray(position),
    new three.Quaternion().fromArray(rotation),
    one,
  );
}

/** The taxels at the border of a rectangle, in the order of a walk round it. */
function outline([top, bottom]: [number, number], [left, right]: [number, number]): [number, number][] {
  const path: [number, number][] = [];
  for (let col = left; col <= right; ++col) path.push([top, col]);
  for (let row = top + 1; row <= bottom; ++row) path.push([row, right]);
  for (let col = right - 1; col >= left; --col) path.push([bottom, col]);
  for (let row = bottom - 1; row > top; --row) path.push([row, left]);
  return path;
}

/** The drawing in the suit's frame: three.js, loaded when the view is first shown. */
export class SuitScene {
  readonly #renderer: three.WebGLRenderer;
  readonly #scene = new three.Scene();
  readonly #camera = new three.PerspectiveCamera(35, 1, 0.001, 100);
  readonly #controls: OrbitControls;
  readonly #arrows = new ContactArrows();
  readonly #zones = new three.Group();
  readonly #zoneInk = new three.LineBasicMaterial();
  readonly #centre = new three.Vector3();
  readonly #projected = new three.Vector3();
  readonly #right = new three.Vector3();
  readonly #up = new three.Vector3();
  /** Where the arrows begin, and what presses there. */
  readonly #tails = Array.from({ length: MOST_ARROWS }, () => new three.Vector3());
  readonly #forces = new Float64Array(MOST_ARROWS);
  readonly #sight = new three.Raycaster();
  readonly #heading = new Heading();
  /** An upright suit is turned; one that lies flat is seen whole from above. */
  #isUpright = false;
  #arrowCount = 0;
  /** Moves of each array, from its place in /suit.json to its present one. */
  #moves: three.Matrix4[] = [];
  #cloud: TaxelCloud | undefined;
  #body: BodyModel | undefined;
  #mannequin: three.Group | undefined;
  readonly #mannequinInk = new three.MeshLambertMaterial();
  #suit: SuitDescription | undefined;
  #isYTurned = false;
  #size = 1;
  #width = 1;
  #height = 1;
  #isDue = true;
  /** By the user: a new size of the page leaves it as it is. */
  #isTurned = false;

  /** `fetchFile`: of the meshes of a body; `failed`: one of them cannot be read. */
  constructor(
    canvas: HTMLCanvasElement,
    readonly fetchFile: FetchFile,
    readonly failed: (why: string) => void,
  ) {
    this.#renderer = new three.WebGLRenderer({ canvas, antialias: true });
    this.#renderer.outputColorSpace = three.LinearSRGBColorSpace;
    three.ColorManagement.enabled = false;
    this.#controls = new OrbitControls(this.#camera, canvas);
    this.#controls.enableDamping = false;
    this.#controls.addEventListener("change", () => (this.#isDue = true));
    this.#controls.addEventListener("start", () => (this.#isTurned = true));
    const lamp = new three.DirectionalLight(0xffffff, 2);
    lamp.position.set(-0.6, 1, 0.8);
    this.#camera.add(lamp, lamp.target);
    this.#scene.add(this.#arrows.group, this.#zones, this.#camera, new three.AmbientLight(0xffffff, 1.6));
  }

  /** `isTurned`: y of the suit, as asOnMap() has it; the contacts that come are turned here. */
  setSuit(suit: SuitDescription, isTurned: boolean): void {
    this.#isYTurned = isTurned;
    if (this.#cloud !== undefined) {
      this.#scene.remove(this.#cloud.mesh);
      this.#cloud.dispose();
    }
    this.#suit = suit;
    this.#cloud = new TaxelCloud(suit);
    this.#scene.add(this.#cloud.mesh);
    const box = new three.Box3();
    const point = new three.Vector3();
    for (const { positions } of suit.arrays)
      for (const position of positions) box.expandByPoint(point.fromArray(position));
    box.getCenter(this.#centre);
    this.#size = Math.max(0.02, box.getSize(point).length());
    this.#moves = suit.arrays.map(() => new three.Matrix4());
    this.#dress(suit);
    this.#drawZones(suit);
    this.home();
    this.readColors();
  }

  /** The body under the arrays, or a mannequin. */
  #dress(suit: SuitDescription): void {
    if (this.#body !== undefined) this.#scene.remove(this.#body.group);
    this.#body?.dispose();
    this.#body = undefined;
    if (this.#mannequin !== undefined) this.#scene.remove(this.#mannequin);
    for (const part of this.#mannequin?.children ?? [])
      for (const { geometry } of part.children as three.Mesh[]) geometry.dispose();
    this.#mannequin = undefined;
    if (suit.body === undefined) {
      this.#mannequin = mannequinOf(suit, this.#size, this.#mannequinInk);
      this.#scene.add(this.#mannequin);
    } else {
      this.#body = new BodyModel(suit.body, this.fetchFile, () => this.#refit(), this.failed);
      this.#scene.add(this.#body.group);
    }
  }

  /** A mesh has come: all of the body is to be seen, where the user has not turned it. */
  #refit(): void {
    if (!this.#isTurned) this.home();
    this.#isDue = true;
  }

  /** Moves arrays and links to where the server has them now. */
  setTransforms(transforms: readonly Transform[]): void {
    if (this.#isYTurned) return; // nothing carries it
    for (const transform of transforms) {
      const { child } = transform;
      if (child.startsWith(LINK_PREFIX)) this.#body?.move(child.slice(LINK_PREFIX.length), transform);
      const array = this.#suit?.arrays.findIndex(({ name }) => name === child) ?? -1;
      if (array >= 0) this.#moveArray(array, transform);
    }
    this.#isDue = true;
  }

  #moveArray(array: number, pose: PlacedPose): void {
    const move = matrixOf(pose).multiply(matrixOf(this.#suit!.arrays[array]!.pose).invert());
    const isSame = move.elements.every((value, index) => Math.abs(value - this.#moves[array]!.elements[index]!) < 1e-9);
    if (isSame) return;
    this.#moves[array] = move;
    this.#cloud?.move(array, move);
    for (const line of this.#zones.children) if (line.userData.array === array) line.matrix.copy(move);
  }

  /** Where a point of an array is now that /suit.json has at `position`. */
  placeOf(array: number, position: readonly [number, number, number]): [number, number, number] {
    const { x, y, z } = this.#projected.fromArray(position).applyMatrix4(this.#moves[array]!);
    return [x, y, z];
  }

  /** A line through the outer taxels of each zone that is limited, a little above them. */
  #drawZones({ arrays }: SuitDescription): void {
    for (const line of this.#zones.children) (line as three.LineLoop).geometry.dispose();
    this.#zones.clear();
    for (const [index, array] of arrays.entries()) {
      for (const [{ rows, cols }] of limitedZones(array)) {
        const points = outline(rows, cols).map(([row, col]) => {
          const taxel = row * array.cols + col;
          const normal = new three.Vector3().fromArray(array.normals[taxel]!);
          return new three.Vector3()
            .fromArray(array.positions[taxel]!)
            .addScaledVector(normal, LIFT_SHARE * this.#size);
        });
        const line = new three.LineLoop(new three.BufferGeometry().setFromPoints(points), this.#zoneInk);
        line.matrixAutoUpdate = false;
        line.userData.array = index;
        this.#zones.add(line);
      }
    }
  }

  /** Looks at the whole suit from before and a little above; lying flat, from above. */
  home(): void {
    this.#isTurned = false;
    this.#heading.stop();
    const facing = this.#meanNormal();
    const liesFlat = Math.abs(facing.z) > 0.6;
    this.#isUpright = !liesFlat;
    this.#camera.up.set(0, liesFlat ? 1 : 0, liesFlat ? 0 : 1);
    if (!liesFlat) facing.setZ(0);
    if (facing.length() < 0.35) facing.set(1, 0, 0);
    const side = new three.Vector3().crossVectors(this.#camera.up, facing).normalize();
    const direction = facing
      .normalize()
      .addScaledVector(side, liesFlat ? 0.25 : 0.6)
      .addScaledVector(this.#camera.up, 0.3)
      .normalize();
    this.#camera.near = 0.01 * this.#size;
    this.#camera.far = 100 * this.#size;
    this.#camera.updateProjectionMatrix();
    this.#fit(direction);
    this.#isDue = true;
  }

  #meanNormal(): three.Vector3 {
    const mean = new three.Vector3();
    const normal = new three.Vector3();
    const normals = (this.#suit?.arrays ?? []).flatMap((array) => array.normals);
    for (const each of normals) mean.add(normal.fromArray(each));
    return mean.divideScalar(Math.max(1, normals.length));
  }

  /** The corners of the boxes round what carries the arrays: of the links of a body, or of a mannequin. */
  #bodyCorners(): three.Vector3[] {
    const corners: three.Vector3[] = [];
    const carriers = new Set((this.#suit?.arrays ?? []).flatMap(({ link }) => (link === undefined ? [] : [link])));
    const dressed = this.#body?.partsOf(carriers) ?? (this.#mannequin === undefined ? [] : [this.#mannequin]);
    for (const part of dressed) part.updateWorldMatrix(true, true);
    for (const whole of dressed)
      whole.traverse((part) => {
        if (!(part instanceof three.Mesh)) return;
        const geometry = part.geometry as three.BufferGeometry;
        geometry.computeBoundingBox();
        const { min, max } = geometry.boundingBox!;
        for (const x of [min.x, max.x])
          for (const y of [min.y, max.y])
            for (const z of [min.z, max.z]) corners.push(new three.Vector3(x, y, z).applyMatrix4(part.matrixWorld));
      });
    return corners;
  }

  /** As near as all taxels and what carries them can be seen, with room for labels at their sides. */
  #fit(direction: three.Vector3, isTurning = false): void {
    const target = this.#controls.target;
    if (!isTurning) target.copy(this.#centre);
    this.#camera.position.copy(target).add(direction);
    this.#controls.update();
    this.#camera.updateMatrixWorld();
    this.#camera.matrixWorld.extractBasis(this.#right, this.#up, this.#projected);
    const points = this.#bodyCorners().map((point) => ({ point, reach: 0 }));
    for (const { positions, cols } of this.#suit?.arrays ?? []) {
      const reach = 0.5 * nearestNeighbour(positions, cols);
      for (const position of positions) points.push({ point: new three.Vector3().fromArray(position), reach });
    }
    if (points.length === 0) return;
    for (let step = isTurning ? CENTRINGS - 1 : 0; step < CENTRINGS; ++step) this.#centreOn(points, direction);
    this.#camera.position.copy(target).addScaledVector(direction, this.#distanceFor(points, direction));
    this.#controls.update();
  }

  /** Tangents of half the picture, as far as the suit may fill it. */
  #halves(): { across: number; high: number } {
    const high = FIT_SHARE * Math.tan(three.MathUtils.degToRad(0.5 * this.#camera.fov));
    return { high, across: high * this.#camera.aspect * (1 - (2 * columnPx(this.#width)) / this.#width) };
  }

  #distanceFor(points: readonly Reaching[], direction: three.Vector3): number {
    const { across, high } = this.#halves();
    return points.reduce((most, { point, reach }) => {
      const way = this.#projected.copy(point).sub(this.#controls.target);
      const far = Math.max(
        (Math.abs(way.dot(this.#right)) + reach) / across,
        (Math.abs(way.dot(this.#up)) + reach) / high,
      );
      return Math.max(most, way.dot(direction) + far);
    }, 0);
  }

  /** Brings the target nearer to the middle of what is seen from this side: half the way, as what is near moves more. */
  #centreOn(points: readonly Reaching[], direction: three.Vector3): void {
    const distance = this.#distanceFor(points, direction);
    const extent = new three.Box2();
    for (const { point } of points) {
      const way = this.#projected.copy(point).sub(this.#controls.target);
      const depth = distance - way.dot(direction);
      extent.expandByPoint(new three.Vector2(way.dot(this.#right) / depth, way.dot(this.#up) / depth));
    }
    const middle = extent.getCenter(new three.Vector2()).multiplyScalar(0.5 * distance);
    this.#controls.target.addScaledVector(this.#right, middle.x).addScaledVector(this.#up, middle.y);
  }

  readColors(): void {
    this.#scene.background = new three.Color(cssColor("--surface"));
    this.#arrows.setColor(cssColor("--accent"));
    this.#zoneInk.color.set(cssColor("--bad"));
    this.#mannequinInk.color.set(cssColor("--fault"));
    this.#cloud?.setColors(
      rgbColor("--fault"),
      rgbColor("--fault-stripe"),
      rgbColor("--accent"),
      rgbColor("--rim"),
      document.documentElement.dataset.theme === "light",
    );
    this.#isDue = true;
  }

  resize(width: number, height: number, pixelRatio: number): void {
    this.#width = Math.max(1, width);
    this.#height = Math.max(1, height);
    this.#renderer.setPixelRatio(pixelRatio);
    this.#renderer.setSize(this.#width, this.#height, false);
    this.#camera.aspect = this.#width / this.#height;
    this.#camera.updateProjectionMatrix();
    if (!this.#isTurned) this.home();
    this.#isDue = true;
  }

  setScale(end: number): void {
    this.#cloud?.setScale(end);
    this.#isDue = true;
  }

  choose(array: number): void {
    this.#cloud?.choose(array);
    this.#isDue = true;
  }

  setForces(points: PointsFrame): void {
    this.#cloud?.setForces(points.newtons, points.statuses);
    this.#isDue = true;
  }

  setContacts(frames: readonly ContactsFrame[], scaleEnd: number): void {
    this.#arrows.begin();
    this.#arrowCount = 0;
    for (const { contacts, count } of frames) {
      for (let index = 0; index < count; ++index) this.#addArrow(contacts[index]!, scaleEnd);
    }
    this.#arrows.end();
    this.#isDue = true;
    this.#look(frames);
  }

  /** Turns itself, until somebody has turned it, so that what is touched is seen. */
  #look(frames: readonly ContactsFrame[]): void {
    if (this.#isTurned || !this.#isUpright) return;
    const pressed = frames
      .flatMap(touchingIn)
      .map(({ normal, forceN }) => ({ normal: new three.Vector3().fromArray(normal), forceN }));
    this.#heading.see(pressed, this.#direction(), this.#camera.up, performance.now());
  }

  /** From the suit to the eye. */
  #direction(): three.Vector3 {
    return this.#camera.position.clone().sub(this.#controls.target).normalize();
  }

  #addArrow(contact: Contact, scaleEnd: number): void {
    const tail = this.#tails[this.#arrowCount];
    if (tail === undefined || contact.phase === ContactPhase.release) return;
    this.#arrows.add(contact, this.#isYTurned, scaleEnd, this.#size, tail);
    this.#forces[this.#arrowCount] = contact.forceN;
    this.#arrowCount += 1;
  }

  /** How long an arrow at the end of the scale is in the middle of the suit, in CSS pixels. */
  get longestArrow(): number {
    const distance = this.#camera.position.distanceTo(this.#controls.target);
    const high = 2 * distance * Math.tan(three.MathUtils.degToRad(0.5 * this.#camera.fov));
    return (LONGEST_SHARE * this.#size * this.#height) / high;
  }

  /** Where x, y and z point on the picture: right, up and towards the eye. */
  axes(): [number, number, number][] {
    const { elements } = this.#camera.matrixWorldInverse;
    return [0, 4, 8].map((at) => {
      const sign = this.#isYTurned && at === 4 ? -1 : 1;
      return [sign * elements[at]!, sign * elements[at + 1]!, sign * elements[at + 2]!];
    });
  }

  get arrowCount(): number {
    return this.#arrowCount;
  }

  arrowForce(index: number): number {
    return this.#forces[index]!;
  }

  /** Where its figure belongs; undefined: it is behind the body or the camera. */
  arrowPlace(index: number): [number, number] | undefined {
    const { x, y, z } = this.#tails[index]!;
    return this.#isHidden(this.#tails[index]!) ? undefined : this.project(x, y, z);
  }

  /** By solids and hulls: meshes of files may have too many triangles to ask. */
  #isHidden(point: three.Vector3): boolean {
    const solids = this.#body?.solids ?? this.#mannequin?.children ?? [];
    const { ray } = this.#sight;
    ray.origin.copy(this.#camera.position);
    ray.direction.copy(point).sub(ray.origin);
    this.#sight.far = ray.direction.length();
    ray.direction.normalize();
    return this.#sight.intersectObjects(solids).length > 0;
  }

  turn(right: number, up: number): void {
    this.#isTurned = true;
    const offset = this.#camera.position.clone().sub(this.#controls.target);
    offset.applyAxisAngle(this.#camera.up, TURN_STEP * right);
    const side = new three.Vector3().crossVectors(this.#camera.up, offset).normalize();
    const tilted = offset.clone().applyAxisAngle(side, -TURN_STEP * up);
    if (tilted.angleTo(this.#camera.up) > 0.1 && tilted.angleTo(this.#camera.up) < Math.PI - 0.1) offset.copy(tilted);
    this.#camera.position.copy(this.#controls.target).add(offset);
    this.#controls.update();
    this.#isDue = true;
  }

  zoom(steps: number): void {
    this.#isTurned = true;
    const offset = this.#camera.position.clone().sub(this.#controls.target);
    this.#camera.position.copy(this.#controls.target).addScaledVector(offset, ZOOM_STEP ** -steps);
    this.#controls.update();
    this.#isDue = true;
  }

  /** True where something was drawn. */
  draw(): boolean {
    const turned = this.#isTurned
      ? undefined
      : this.#heading.step(this.#direction(), this.#camera.up, performance.now());
    if (turned !== undefined) this.#fit(turned, true);
    this.#isDue ||= turned !== undefined;
    if (!this.#isDue) return false;
    this.#isDue = false;
    this.#renderer.render(this.#scene, this.#camera);
    return true;
  }

  /** Where a point of the suit is on the canvas, in CSS pixels; behind the camera: undefined. */
  project(x: number, y: number, z: number): [number, number] | undefined {
    this.#projected.set(x, y, z).project(this.#camera);
    if (this.#projected.z > 1) return undefined;
    return [(0.5 + 0.5 * this.#projected.x) * this.#width, (0.5 - 0.5 * this.#projected.y) * this.#height];
  }

  /** The array at a place of the canvas; -1: none. */
  arrayAt(x: number, y: number): number {
    const ray = new three.Raycaster();
    ray.setFromCamera(new three.Vector2((2 * x) / this.#width - 1, 1 - (2 * y) / this.#height), this.#camera);
    const point = new three.Vector3();
    let found = -1;
    let nearest = Infinity;
    (this.#suit?.arrays ?? []).forEach(({ positions }, array) => {
      for (const position of positions) {
        point.fromArray(this.placeOf(array, position));
        const depth = point.distanceTo(this.#camera.position);
        if (depth < nearest && ray.ray.distanceToPoint(point) < CLICK_SHARE * this.#size)
          [found, nearest] = [array, depth];
      }
    });
    return found;
  }
}
