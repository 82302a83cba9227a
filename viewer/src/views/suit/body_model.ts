// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import * as three from "three";
import { errorText } from "../../format";
import type { BodyDescription, BodyVisual, PlacedPose } from "../../suit";

const ROUND = 32;

/** Reads a file of the server. */
export type FetchFile = (path: string) => Promise<ArrayBuffer>;

function put(object: three.Object3D, { position, rotation }: PlacedPose): void {
  object.position.fromArray(position);
  object.quaternion.fromArray(rotation);
}

function material({ rgba }: BodyVisual): three.MeshLambertMaterial {
  const [red, green, blue, opacity] = rgba ?? [0.55, 0.58, 0.63, 1];
  return new three.MeshLambertMaterial({ color: new three.Color(red, green, blue), opacity, transparent: opacity < 1 });
}

function solidGeometry({ solid, size }: BodyVisual): three.BufferGeometry | undefined {
  const [a = 0, b = 0, c = 0] = size;
  if (solid === "box") return new three.BoxGeometry(a, b, c);
  if (solid === "cylinder") return new three.CylinderGeometry(a, a, b, ROUND).rotateX(0.5 * Math.PI);
  if (solid === "sphere") return new three.SphereGeometry(a, ROUND, ROUND / 2);
  return undefined;
}

/** The triangles of a file, which the loaders of three.js read when one is there. */
async function meshOf(path: string, bytes: ArrayBuffer, ink: three.Material): Promise<three.Object3D> {
  if (path.endsWith(".stl")) {
    const { STLLoader } = await import("three/addons/loaders/STLLoader.js");
    return new three.Mesh(new STLLoader().parse(bytes), ink);
  }
  const { GLTFLoader } = await import("three/addons/loaders/GLTFLoader.js");
  const { scene } = await new GLTFLoader().parseAsync(bytes, "");
  scene.traverse((object) => {
    if (object instanceof three.Mesh) object.material = ink;
  });
  return scene;
}

/** The visible links of a body. */
export class BodyModel {
  readonly group = new three.Group();
  /** Boxes, cylinders and spheres. */
  readonly solids: three.Mesh[] = [];
  readonly #links = new Map<string, three.Group>();

  /** `changed`: a file has come. `failed`: one cannot be read. */
  constructor(body: BodyDescription, fetchFile: FetchFile, changed: () => void, failed: (why: string) => void) {
    for (const { name, pose, visuals } of body.links) {
      const link = new three.Group();
      put(link, pose);
      this.#links.set(name, link);
      this.group.add(link);
      for (const visual of visuals) this.#add(link, visual, fetchFile, changed, failed);
    }
  }

  #add(
    link: three.Group,
    visual: BodyVisual,
    fetchFile: FetchFile,
    changed: () => void,
    failed: (why: string) => void,
  ): void {
    const holder = new three.Group();
    put(holder, visual.pose);
    link.add(holder);
    const ink = material(visual);
    const geometry = solidGeometry(visual);
    if (geometry !== undefined) {
      const solid = new three.Mesh(geometry, ink);
      this.solids.push(solid);
      holder.add(solid);
    }
    const { file } = visual;
    if (file === undefined) return;
    holder.scale.fromArray(visual.size);
    void fetchFile(file)
      .then((bytes) => meshOf(file, bytes, ink))
      .then((mesh) => {
        holder.add(mesh);
        changed();
      })
      .catch((error: unknown) => failed(`${visual.name ?? file}: ${errorText(error)}`));
  }

  /** Those of the links; all where none is of the body. */
  partsOf(names: ReadonlySet<string>): readonly three.Object3D[] {
    const parts = [...this.#links].flatMap(([name, link]) => (names.has(name) ? [link] : []));
    return parts.length > 0 ? parts : [this.group];
  }

  move(name: string, pose: PlacedPose): void {
    const link = this.#links.get(name);
    if (link !== undefined) put(link, pose);
  }

  /** Frees what the graphics card holds. */
  dispose(): void {
    this.group.traverse((part) => {
      if (!(part instanceof three.Mesh)) return;
      part.geometry.dispose();
      (part.material as three.Material).dispose();
    });
  }
}
