// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

import { readFileSync } from "node:fs";
import { describe, expect, it } from "vitest";
import { COEFFICIENTS, colorOf, cssGradient, rgbOf, shaderSource, TOE_COLORS, TOE_SHARE } from "./color_map";

/** OKLab: distances in it are differences to the eye (Ottosson, 2020). */
function oklab(share: number, fromLight = false): [number, number, number] {
  const [red, green, blue] = rgbOf(share, fromLight).map((value) =>
    value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4,
  ) as [number, number, number];
  const long = Math.cbrt(0.4122214708 * red + 0.5363325363 * green + 0.0514459929 * blue);
  const medium = Math.cbrt(0.2119034982 * red + 0.6806995451 * green + 0.1073969566 * blue);
  const short = Math.cbrt(0.0883024619 * red + 0.2817188376 * green + 0.6299787005 * blue);
  return [
    0.2104542553 * long + 0.793617785 * medium - 0.0040720468 * short,
    1.9779984951 * long - 2.428592205 * medium + 0.4505937099 * short,
    0.0259040371 * long + 0.7827717662 * medium - 0.808675766 * short,
  ];
}

const STEPS = 64;
/** From the first percent on. */
const colors = Array.from({ length: STEPS + 1 }, (_, step) => oklab(TOE_SHARE + ((1 - TOE_SHARE) * step) / STEPS));

function distance(one: readonly number[], other: readonly number[]): number {
  return Math.hypot(...one.map((value, index) => value - other[index]!));
}

describe("the colour map", () => {
  it("becomes lighter with every step, from nearly black to nearly white", () => {
    for (let step = 1; step <= STEPS; ++step) expect(colors[step]![0]).toBeGreaterThan(colors[step - 1]![0]);
    expect(oklab(0)[0]).toBeLessThan(0.2);
    expect(colors[STEPS]![0]).toBeGreaterThan(0.93);
  });

  it("changes by equal steps to the eye, within a fifth", () => {
    const distances = colors.slice(1).map((color, step) => distance(color, colors[step]!));
    const mean = distances.reduce((sum, one) => sum + one, 0) / STEPS;
    for (const one of distances) expect(Math.abs(one / mean - 1)).toBeLessThan(0.2);
  });

  it("tells the first percent from nothing, dark and light", () => {
    const justSeen = 0.02;
    for (const fromLight of [false, true])
      expect(distance(oklab(0.01, fromLight), oklab(0, fromLight))).toBeGreaterThan(4 * justSeen);
    expect(cssGradient(true)).toContain(`${colorOf(0.01, true)} 1.00%`);
  });

  it("shows nothing of noise, a quarter of the first percent, dark and light", () => {
    const justSeen = 0.02;
    for (const fromLight of [false, true])
      expect(distance(oklab(0.0025, fromLight), oklab(0, fromLight))).toBeLessThan(justSeen / 4);
  });

  it("leaves a sheet at rest the white of its panel in the light theme", () => {
    expect(rgbOf(0, true)).toEqual([1, 1, 1]);
    expect(rgbOf(TOE_SHARE, true)).toEqual(
      rgbOf(TOE_SHARE * (1 + 1e-12), true).map((value) => expect.closeTo(value, 6)),
    );
    expect(shaderSource()).toContain("vec3(1.0), white");
  });

  it("is the palette of terminals, pictures and reports", () => {
    const header = readFileSync("../src/out/report/palette.hpp", "utf8");
    const rows = [...header.matchAll(/\{(-?[\d.]+), (-?[\d.]+), (-?[\d.]+)\}/g)].map((match) =>
      match.slice(1).map(Number),
    );
    expect(rows).toEqual(COEFFICIENTS);
    const constant = (name: string): number => Number(new RegExp(`${name} = ([\\d.]+);`).exec(header)![1]);
    expect([constant("kToeShare"), constant("kToeColours")]).toEqual([TOE_SHARE, TOE_COLORS]);
  });

  it("keeps the colour of its ends beyond them", () => {
    expect(colorOf(-1)).toBe(colorOf(0));
    expect(colorOf(7)).toBe(colorOf(1));
    expect(colorOf(0)).toMatch(/^rgb\(\d+ \d+ \d+\)$/);
  });

  it("is the same polynomial in the shader", () => {
    const [source = ""] = shaderSource().split("float opposite");
    const vectors = [...source.matchAll(/vec3\((-?[\d.]+), (-?[\d.]+), (-?[\d.]+)\)/g)].map((match) =>
      match.slice(1).map(Number),
    );
    const share = 0.37;
    const place = TOE_COLORS + ((share - TOE_SHARE) * (1 - TOE_COLORS)) / (1 - TOE_SHARE);
    const green = vectors.reduce((sum, vector, power) => sum + vector[1]! * place ** power, 0);
    expect(green).toBeCloseTo(rgbOf(share)[1], 3);
  });
});
