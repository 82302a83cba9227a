// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { timeOfDay } from "../format";
import { type GridFrame, TaxelStatus } from "../messages/grids";
import { colorOf, rgbOf, TOE_COLORS, TOE_SHARE } from "../render/color_map";

/** A frame to be drawn, with what stands beside it. */
export interface Pictured {
  array: string;
  unit: string;
  /** End of the colour scale, which begins at 0. */
  end: number;
  frame: GridFrame;
}

const MAP_PX = 480;
const MOST_CELL_PX = 48;
const MARGIN_PX = 12;
const LINE_PX = 24;
const SCALE_PX = 12;
const FONT = "14px sans-serif";
const NO_VALUE = "#9a9a9a";
/** So many colours of the palette of a film are of the scale; the others are grey. */
const SCALE_COLORS = 208;

/** 1, 2 or 5 times a power of ten: the least that holds the value. */
export function roundEnd(value: number): number {
  if (!(value > 0) || !Number.isFinite(value)) return 1;
  const power = 10 ** Math.floor(Math.log10(value));
  const factor = [1, 2, 5, 10].find((step) => step * power >= value * (1 - 1e-9)) ?? 10;
  return Number((factor * power).toPrecision(1));
}

/** The highest value of a taxel that has one. */
export function highest({ values, statuses }: GridFrame): number {
  let most = 0;
  values.forEach((value, taxel) => {
    if (hasValue(value, statuses[taxel]!)) most = Math.max(most, value);
  });
  return most;
}

function hasValue(value: number, status: number): boolean {
  return Number.isFinite(value) && status < TaxelStatus.dead;
}

function cellPx({ rows, cols }: GridFrame): number {
  return Math.max(1, Math.min(MOST_CELL_PX, Math.floor(MAP_PX / Math.max(rows, cols))));
}

/** Width and height of the picture of such a frame [px]. */
export function pictureSize(frame: GridFrame): [width: number, height: number] {
  const cell = cellPx(frame);
  return [Math.max(220, frame.cols * cell) + 2 * MARGIN_PX, frame.rows * cell + 2 * LINE_PX + SCALE_PX + 2 * MARGIN_PX];
}

/** On white, with name, time and scale: it can be read without the page. */
export function drawPicture(context: CanvasRenderingContext2D, { array, unit, end, frame }: Pictured): void {
  const [width, height] = pictureSize(frame);
  const cell = cellPx(frame);
  context.fillStyle = "#ffffff";
  context.fillRect(0, 0, width, height);
  context.fillStyle = "#000000";
  context.font = FONT;
  context.textBaseline = "middle";
  context.fillText(`${array}  ${timeOfDay(frame.stampS)}`, MARGIN_PX, MARGIN_PX + LINE_PX / 2);
  const top = MARGIN_PX + LINE_PX;
  for (let taxel = 0; taxel < frame.rows * frame.cols; ++taxel) {
    const value = frame.values[taxel]!;
    context.fillStyle = hasValue(value, frame.statuses[taxel]!) ? colorOf(value / end, true) : NO_VALUE;
    context.fillRect(MARGIN_PX + (taxel % frame.cols) * cell, top + Math.floor(taxel / frame.cols) * cell, cell, cell);
  }
  drawScale(context, top + frame.rows * cell + MARGIN_PX / 2, width - 2 * MARGIN_PX, `${end} ${unit}`);
}

function drawScale(context: CanvasRenderingContext2D, top: number, width: number, end: string): void {
  for (let x = 0; x < width; ++x) {
    context.fillStyle = colorOf(x / (width - 1), true);
    context.fillRect(MARGIN_PX + x, top, 1, SCALE_PX);
  }
  context.fillStyle = "#000000";
  context.fillText("0", MARGIN_PX, top + SCALE_PX + LINE_PX / 2);
  context.textAlign = "right";
  context.fillText(end, MARGIN_PX + width, top + SCALE_PX + LINE_PX / 2);
  context.textAlign = "left";
}

/** The share of the scale at a place of the palette. */
function shareOf(place: number): number {
  return place < TOE_COLORS
    ? (place * TOE_SHARE) / TOE_COLORS
    : TOE_SHARE + ((place - TOE_COLORS) * (1 - TOE_SHARE)) / (1 - TOE_COLORS);
}

/** The colours of the pictures of a film. */
export function filmPalette(): Uint8Array {
  const palette = new Uint8Array(768);
  for (let index = 0; index < 256; ++index) {
    const grey = (index - SCALE_COLORS) / (255 - SCALE_COLORS);
    const color = index < SCALE_COLORS ? rgbOf(shareOf(index / (SCALE_COLORS - 1)), true) : [grey, grey, grey];
    color.forEach((channel, at) => (palette[3 * index + at] = Math.round(255 * channel)));
  }
  return palette;
}

/** Finds the nearest colours of a palette; those that it has seen at once. */
export class PaletteFinder {
  readonly #palette: Uint8Array;
  readonly #known = new Map<number, number>();

  constructor(palette: Uint8Array) {
    this.#palette = palette;
  }

  /** `rgba`: of a canvas. */
  indices(rgba: Uint8ClampedArray): Uint8Array {
    const indices = new Uint8Array(rgba.length / 4);
    for (let pixel = 0; pixel < indices.length; ++pixel) {
      const key = (rgba[4 * pixel]! << 16) | (rgba[4 * pixel + 1]! << 8) | rgba[4 * pixel + 2]!;
      const index = this.#known.get(key) ?? this.#nearest(key >> 16, (key >> 8) & 255, key & 255);
      this.#known.set(key, index);
      indices[pixel] = index;
    }
    return indices;
  }

  #nearest(red: number, green: number, blue: number): number {
    let best = 0;
    let least = Infinity;
    for (let index = 0; index < 256; ++index) {
      const distance =
        (this.#palette[3 * index]! - red) ** 2 +
        (this.#palette[3 * index + 1]! - green) ** 2 +
        (this.#palette[3 * index + 2]! - blue) ** 2;
      if (distance < least) [best, least] = [index, distance];
    }
    return best;
  }
}
