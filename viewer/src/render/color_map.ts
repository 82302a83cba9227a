// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

/**
 * The palette of every map, also in terminals, pictures and reports (src/out/report/palette.hpp, held equal by a test).
 *
 * From ink through red to pale yellow, in equal steps to the eye: lightness and distance in OKLab rise evenly. So a map
 * shows no edge that the forces have not, and reads the same in grey. Rows: coefficients of share^0, share^1, ... for
 * red, green, blue in sRGB.
 */
export const COEFFICIENTS: readonly (readonly [number, number, number])[] = [
  [0.0479, 0.0528, 0.1676],
  [0.4204, 0.5649, 1.3116],
  [6.8652, -0.6374, 4.4242],
  [-18.8601, -4.9426, -30.1666],
  [28.3001, 20.3941, 50.8979],
  [-24.5515, -22.1484, -35.9475],
  [8.755, 7.6851, 9.9848],
];

/**
 * So much of the colours lies between 0 and the first percent of the scale: a light press differs from nothing. They rise
 * by the cube of the share: noise, which is a small part of that percent, looks like nothing.
 */
export const TOE_SHARE = 0.01;
export const TOE_COLORS = 0.1;

/** How far the first percent is left behind, 0 to 1, as the eye is to see it. */
function leftToe(inside: number): number {
  return Math.min(1, inside / TOE_SHARE) ** 3;
}

function toed(share: number): number {
  const inside = Math.min(1, Math.max(0, share));
  return inside < TOE_SHARE
    ? TOE_COLORS * leftToe(inside)
    : TOE_COLORS + ((inside - TOE_SHARE) * (1 - TOE_COLORS)) / (1 - TOE_SHARE);
}

function channel(share: number, index: 0 | 1 | 2): number {
  let value = 0;
  for (let power = COEFFICIENTS.length - 1; power >= 0; --power) value = value * share + COEFFICIENTS[power]![index];
  return Math.min(1, Math.max(0, value));
}

/**
 * Red, green and blue in 0 ... 1 of a share of the scale; beyond its ends the colour of the end. The light theme reads the
 * palette backwards (`fromLight`). There a sheet at rest has the white of its panel, which the first percent leaves.
 */
export function rgbOf(share: number, fromLight = false): [number, number, number] {
  const place = fromLight ? 1 - Math.max(toed(share), TOE_COLORS) : toed(share);
  const white = fromLight ? 1 - leftToe(Math.max(0, share)) : 0;
  const mixed = (index: 0 | 1 | 2): number => channel(place, index) * (1 - white) + white;
  return [mixed(0), mixed(1), mixed(2)];
}

export function colorOf(share: number, fromLight = false): string {
  const [red, green, blue] = rgbOf(share, fromLight);
  return `rgb(${Math.round(255 * red)} ${Math.round(255 * green)} ${Math.round(255 * blue)})`;
}

/** The scale from left to right. */
export function cssGradient(fromLight: boolean): string {
  const shares = [0, 0.5 * TOE_SHARE, TOE_SHARE, ...Array.from({ length: 24 }, (_, index) => (index + 1) / 24)];
  const stops = shares.map((share) => `${colorOf(share, fromLight)} ${(100 * share).toFixed(2)}%`);
  return `linear-gradient(to right, ${stops.join(", ")})`;
}

function slope(value: number): string {
  return value.toFixed(6);
}

/** GLSL: vec3 color_map(float share) with the uniform from_light, and float opposite(vec3 color): the tone that is seen on it. */
export function shaderSource(): string {
  const vectors = COEFFICIENTS.map((row) => `vec3(${row.map((value) => value.toFixed(4)).join(", ")})`);
  const horner = vectors.reduceRight((inner, vector) => (inner === "" ? vector : `${vector} + x * (${inner})`), "");
  return `uniform bool from_light;

vec3 color_map(float share) {
  float inside = clamp(share, 0.0, 1.0);
  float left_toe = pow(min(1.0, inside / ${TOE_SHARE}), 3.0);
  float x = inside < ${TOE_SHARE} ? ${TOE_COLORS} * left_toe : ${TOE_COLORS} + (inside - ${TOE_SHARE}) * ${slope((1 - TOE_COLORS) / (1 - TOE_SHARE))};
  if (from_light) x = 1.0 - max(x, ${TOE_COLORS});
  float white = from_light ? 1.0 - left_toe : 0.0;
  return mix(clamp(${horner}, 0.0, 1.0), vec3(1.0), white);
}

float opposite(vec3 color) {
  return dot(color, vec3(0.3, 0.6, 0.1)) > 0.5 ? 0.0 : 1.0;
}`;
}
