// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { engineering } from "../../format";
import type { ArrayDescription } from "../../suit";

/** The quantity that a map of an array shows. */
export interface Quantity {
  readonly name: "raw" | "conductance" | "force" | "pressure";
  readonly title: string;
  readonly unit: string;
  /** Ends that the scale may have, rising. */
  ends(array: ArrayDescription): number[];
  firstEnd(array: ArrayDescription): number;
  /** The value of a tick, in the prefix that suits the end of the scale. */
  label(value: number, end: number): string;
}

/** Places in QUANTITIES. */
export const RAW = 0;
export const CONDUCTANCE = 1;
export const FORCE = 2;
export const PRESSURE = 3;

const COUNT_DIVISORS = [64, 32, 16, 8, 4, 2, 1];
const SIEMENS_ENDS = [2e-5, 5e-5, 1e-4, 2e-4, 5e-4, 1e-3, 2e-3, 5e-3, 1e-2, 2e-2];
const NEWTON_ENDS = [0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100];
const PASCAL_ENDS = [5e2, 1e3, 2e3, 5e3, 1e4, 2e4, 5e4, 1e5, 2e5, 5e5, 1e6, 2e6, 5e6];
const FIRST_NEWTONS = 10;

/** The area on which the force of a taxel acts, as contacts have it: by default a disc of 0.7 pitches. */
export function taxelAreaM2({ taxel_area_m2, pitch_m }: ArrayDescription): number {
  return taxel_area_m2 ?? 0.25 * Math.PI * (0.7 * Math.min(...pitch_m)) ** 2;
}

/** The lowest of the ends that holds a value; the last one where none does. */
export function endThatHolds(value: number, ends: readonly number[]): number {
  return ends.find((end) => end >= value) ?? ends.at(-1)!;
}

function trimmed(value: number): string {
  return Number(value.toPrecision(4)).toString();
}

export const QUANTITIES: readonly Quantity[] = [
  {
    name: "raw",
    title: "Raw",
    unit: "counts",
    ends: (array) => COUNT_DIVISORS.map((divisor) => Math.round(array.full_scale_counts / divisor)),
    firstEnd: (array) => Math.round(array.full_scale_counts / (array.calibrated ? 4 : 1)),
    label: (value) => Math.round(value).toString(),
  },
  {
    name: "conductance",
    title: "Compensated",
    unit: "S",
    ends: () => SIEMENS_ENDS,
    firstEnd: () => 1e-3,
    label: (value, end) => (end >= 1e-3 ? `${trimmed(1e3 * value)}` : `${trimmed(1e6 * value)}`),
  },
  {
    name: "force",
    title: "Force",
    unit: "N",
    ends: () => NEWTON_ENDS,
    firstEnd: () => FIRST_NEWTONS,
    label: (value) => trimmed(value),
  },
  {
    name: "pressure",
    title: "Pressure",
    unit: "kPa",
    ends: () => PASCAL_ENDS,
    firstEnd: (array) => endThatHolds(FIRST_NEWTONS / taxelAreaM2(array), PASCAL_ENDS),
    label: (value) => trimmed(1e-3 * value),
  },
];

/** "20 N", "500 \u00b5S", "4095 counts". */
export function endLabel(quantity: Quantity, end: number): string {
  if (quantity.name === "conductance") return `${quantity.label(end, end)} ${shownUnit(quantity, end)}`;
  return `${quantity.label(end, end)} ${quantity.unit}`;
}

export function shownUnit(quantity: Quantity, end: number): string {
  if (quantity.name !== "conductance") return quantity.unit;
  return end >= 1e-3 ? "mS" : "\u00b5S";
}

export function ohms(siemens: number): string {
  return siemens > 0 ? engineering(1 / siemens, "\u2126") : engineering(Infinity, "\u2126");
}
