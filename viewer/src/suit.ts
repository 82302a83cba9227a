// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { Signal } from "./signal";

/** A rectangle of taxels: first and last of its rows and columns. */
export interface Zone {
  name: string;
  rows: [number, number];
  cols: [number, number];
}

/** A value that must not be exceeded, in a zone or (null) anywhere on the array. */
export interface Limit {
  name: string;
  quantity: string;
  limit: number;
  unit: string;
  zone: Zone | null;
}

/** Where something is: metres, and a rotation as x, y, z, w. */
export interface PlacedPose {
  position: [number, number, number];
  rotation: [number, number, number, number];
}

/**
 * The visible shape of a link. `size`: sides of a box; radius and length of a cylinder; radius of a sphere; scale of a
 * mesh.
 */
export interface BodyVisual {
  pose: PlacedPose;
  solid: "box" | "cylinder" | "sphere" | "mesh";
  size: number[];
  /** URL of a mesh on the server; missing where it does not give it. */
  file?: string;
  /** Name of a mesh in the description. */
  name?: string;
  rgba?: [number, number, number, number];
}

/** The body that wears the suit; its links are where they are now. */
export interface BodyDescription {
  name: string;
  links: { name: string; pose: PlacedPose; visuals: BodyVisual[] }[];
}

/** The disc of a taxel in no grid: x to the right, y down, radius [m]. */
export type FreePlace = [number, number, number];

/** One array, as /suit.json describes it. */
export interface ArrayDescription {
  name: string;
  rows: number;
  cols: number;
  pitch_m: [number, number];
  taxel_area_m2: number | null;
  full_scale_counts: number;
  full_scale_n: number;
  positions: [number, number, number][];
  normals: [number, number, number][];
  /** Those of the taxels on a flat picture; missing where they are in a grid. */
  places?: FreePlace[];
  /** Pose of the array's frame in the suit's, as the positions have it. */
  pose: PlacedPose;
  /** Link of the body that carries it; missing where there is none. */
  link?: string;
  /** No taxel has a force yet: there are counts alone. */
  calibrated: boolean;
  /** Names for its touches; missing where they have none. */
  classes?: string[];
  /** Missing where nothing is limited. */
  limits?: Limit[];
}

/** An array of which nothing is written yet, as its source shows it. */
export interface ArraySetup {
  /** Empty: the user chooses where the array is. */
  from: string;
  /** Frames come; else rows and columns are those that they would likely have. */
  readable: boolean;
  /** Lines of a recording are turned already. */
  turnable: boolean;
  rows: number | null;
  cols: number | null;
  message: string;
  /** By which the source is read, as TOML; empty: nobody has chosen one. */
  layout: string;
  /** The first of those of which no frame is made, two hexadecimal digits each. */
  bytes: string;
}

export interface SuitDescription {
  name: string;
  arrays: ArrayDescription[];
  body?: BodyDescription;
  /** Where a user has to describe the array first. */
  setup?: ArraySetup;
}

/** The suit that is served and the array that the user looks at. */
export class Suit {
  readonly description = new Signal<SuitDescription>({ name: "", arrays: [] });
  readonly selected = new Signal<ArrayDescription | undefined>(undefined);

  /** Keeps the array that is selected where the new description has one of its name. */
  replace(description: SuitDescription): void {
    this.description.value = description;
    this.select(this.selected.value?.name ?? "");
  }

  /** The first array where there is none of that name. */
  select(name: string): void {
    const { arrays } = this.description.value;
    this.selected.value = arrays.find((array) => array.name === name) ?? arrays[0];
  }

  indexOf(name: string): number {
    return this.description.value.arrays.findIndex((array) => array.name === name);
  }
}
