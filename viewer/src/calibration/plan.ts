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

/** "1, 2.5 5" as numbers; undefined where it is no list of 1 to 16 different weights. */
export function readWeights(text: string): number[] | undefined {
  const weights = text
    .split(/[\s,;]+/)
    .filter((word) => word !== "")
    .map(Number);
  const isWeight = (weight: number): boolean => weight >= 0.01 && weight <= 1000;
  const good =
    weights.length >= 1 && weights.length <= 16 && weights.every(isWeight) && new Set(weights).size === weights.length;
  return good ? weights : undefined;
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
  const grams = (newtons * 1000) / 9.80665;
  return grams < 1000 ? `${grams.toFixed(0)} g` : `${(grams / 1000).toFixed(2)} kg`;
}
