// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { engineering } from "../../format";
import type { ArrayDescription } from "../../suit";

/** What the three maps of an array show. */
export interface Quantity {
  readonly name: "raw" | "conductance" | "force";
  readonly title: string;
  readonly unit: string;
  /** Ends that the scale may have. */
  ends(array: ArrayDescription): number[];
  firstEnd(array: ArrayDescription): number;
  /** The value of a tick, in the prefix that suits the end of the scale. */
  label(value: number, end: number): string;
}

const COUNT_DIVISORS = [1, 2, 4, 8, 16];
const SIEMENS_ENDS = [2e-5, 5e-5, 1e-4, 2e-4, 5e-4, 1e-3, 2e-3, 5e-3, 1e-2, 2e-2];
const NEWTON_ENDS = [0.5, 1, 2, 5, 10, 20, 50, 100];

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
    firstEnd: () => 10,
    label: (value) => trimmed(value),
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
