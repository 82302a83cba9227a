// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import type { ArrayDescription } from "../suit";

export const DEFAULT_WEIGHTS_N = [1, 2, 5, 10, 20] as const;
const DEFAULT_TAXELS = 16;
const SECONDS_OF_PRESS = 4;

/** Which taxels are pressed: every so many rows and columns, or the server's choice of about 16. */
export const TAXEL_CHOICES = [
  { name: "some", words: "about 16, all over the array" },
  { name: "2", words: "every second row and column" },
  { name: "1", words: "all" },
] as const;
export type TaxelChoice = (typeof TAXEL_CHOICES)[number]["name"];

/** The request of /calibration/start. */
export interface StartRequest {
  array: string;
  weights_n: number[];
  taxels?: { stride: number };
  unloaded_s: number;
  hold_s: number;
}

const GRAVITY = 9.80665;
const MOST_PASCAL = 2e6; // that rubber bears
const WEIGHT = /(\d+(?:\.\d*)?|\.\d+)(?:e([+-]?\d+))?\s*([a-z]*)/iy;
const SEPARATORS = /[\s,;]*/y;
const NEWTONS = {
  N: 1,
  mN: 1e-3,
  kN: 1e3,
  g: 1e-3 * GRAVITY,
  kg: GRAVITY,
} as const;

/** Area of a taxel [m2], that of the pitch where none is told. */
function areaOf({ taxel_area_m2, pitch_m }: ArrayDescription): number {
  return Math.max(taxel_area_m2 ?? 0, pitch_m[0] * pitch_m[1]);
}

/** "100 g, 500" as [100, "g"] and [500, "g"]: a number has the unit before it, or else the one behind. */
function withUnits(text: string): [number, string][] | undefined {
  const weights: [number, string][] = [];
  SEPARATORS.lastIndex = 0;
  SEPARATORS.test(text);
  for (
    WEIGHT.lastIndex = SEPARATORS.lastIndex;
    WEIGHT.lastIndex < text.length;
    WEIGHT.lastIndex = SEPARATORS.lastIndex
  ) {
    const found = WEIGHT.exec(text);
    if (found === null) return undefined;
    weights.push([Number(`${found[1]}e${found[2] ?? 0}`), found[3] ?? ""]);
    SEPARATORS.lastIndex = WEIGHT.lastIndex;
    SEPARATORS.test(text);
  }
  let unit = weights.find(([, named]) => named !== "")?.[1] ?? "N";
  return weights.map(([value, named]) => {
    unit = named || unit;
    return [value, unit];
  });
}

/** The weights of a text, and what they were taken for where that is not what it says. */
export interface Weights {
  newtons: number[];
  taken: string;
}

/** "1, 2.5 5", "100 g, 500" or "20 kPa"; undefined where it is no list of 1 to 16 different weights. */
export function readWeights(text: string, array?: ArrayDescription): Weights | undefined {
  const units = new Map(Object.entries(NEWTONS));
  if (array !== undefined) units.set("kPa", 1e3 * areaOf(array));
  const written = withUnits(text);
  const newtons = written?.map(([value, unit]) => value * (units.get(unit) ?? Number.NaN)) ?? [];
  const isWeight = (weight: number): boolean => weight >= 0.01 && weight <= 1000;
  const good =
    newtons.length >= 1 && newtons.length <= 16 && newtons.every(isWeight) && new Set(newtons).size === newtons.length;
  if (!good || written === undefined) return undefined;
  const isPlain = written.every(([, unit]) => unit === "N");
  const words = written.map(([value, unit]) => `${value} ${unit}`).join(", ");
  const taken = `${words}, taken for ${newtons.map((weight) => Number(weight.toPrecision(4))).join(", ")} N`;
  return { newtons, taken: isPlain ? "" : taken };
}

/** Asks about a weight that no rubber bears on one taxel. */
export function questionOn(newtons: readonly number[], array: ArrayDescription): string {
  const heaviest = Math.max(...newtons);
  const pascal = heaviest / areaOf(array);
  if (pascal <= MOST_PASCAL) return "";
  const cm2 = Number((1e4 * areaOf(array)).toPrecision(2));
  const likely = pascal * NEWTONS.g <= MOST_PASCAL ? ` Is it ${Number(heaviest.toPrecision(4))} g?` : "";
  return `${Number(heaviest.toPrecision(4))} N on a taxel of ${cm2} cm² is ${(1e-6 * pascal).toPrecision(2)} MPa.${likely}`;
}

export function strideOf(choice: TaxelChoice, { rows, cols }: ArrayDescription): number {
  return choice === "some" ? Math.max(1, Math.round(Math.sqrt((rows * cols) / DEFAULT_TAXELS))) : Number(choice);
}

/** Row-major, as the server chooses them: the first and the last line as far from the edges as each other. */
export function taxelsOf(choice: TaxelChoice, array: ArrayDescription): number[] {
  const stride = strideOf(choice, array);
  const lines = (count: number): number[] => {
    const first = Math.floor(((count - 1) % stride) / 2);
    return Array.from({ length: Math.ceil((count - first) / stride) }, (_, line) => first + line * stride);
  };
  return lines(array.rows).flatMap((row) => lines(array.cols).map((col) => row * array.cols + col));
}

/** "80 presses, about 5 minutes". */
export function describeWork(presses: number): string {
  const minutes = (presses * SECONDS_OF_PRESS) / 60;
  const time = minutes < 90 ? `${Math.max(1, Math.round(minutes))} min` : `${(minutes / 60).toFixed(1)} h`;
  return `${presses} presses, about ${time}`;
}

/** The weight of a load of so many newtons, for a kitchen scale. */
export function inGrams(newtons: number): string {
  const grams = (newtons * 1000) / GRAVITY;
  return grams < 1000 ? `${grams.toFixed(0)} g` : `${(grams / 1000).toFixed(2)} kg`;
}
