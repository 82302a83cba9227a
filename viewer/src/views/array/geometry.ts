// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import type { Area } from "../../render/heat_maps";
import type { ArrayDescription, FreePlace } from "../../suit";

/** Around a map, for the numbers of its rows and columns. */
export const AXIS_LEFT = 26;
export const AXIS_BOTTOM = 18;
/** At the right of a map of forces, for the labels of its contacts. */
export const LABEL_MARGIN = 96;

const SMALLEST_WHOLE_CELL = 4;

/** First and last of some lines. */
type Lines = readonly [number, number];

/** The rectangle round discs. */
export function boundsOf(places: readonly FreePlace[]): Area {
  const left = Math.min(...places.map(([x, , radius]) => x - radius));
  const top = Math.min(...places.map(([, y, radius]) => y - radius));
  return {
    left,
    top,
    width: Math.max(...places.map(([x, , radius]) => x + radius)) - left,
    height: Math.max(...places.map(([, y, radius]) => y + radius)) - top,
  };
}

/** The largest place inside `room` with the proportions of the array, and cells of whole pixels where it is a grid. */
export function fitMap(room: Area, array: ArrayDescription, margin = 0): Area {
  const width = Math.max(1, room.width - AXIS_LEFT - margin);
  const height = Math.max(1, room.height - AXIS_BOTTOM);
  const [rowPitch, colPitch] = array.pitch_m;
  const bounds = array.places && boundsOf(array.places);
  const [acrossM, downM] = bounds ? [bounds.width, bounds.height] : [array.cols * colPitch, array.rows * rowPitch];
  const scale = Math.min(width / acrossM, height / downM);
  const whole = (pixels: number): number => (pixels >= SMALLEST_WHOLE_CELL ? Math.floor(pixels) : pixels);
  const mapWidth = bounds ? acrossM * scale : whole(colPitch * scale) * array.cols;
  const mapHeight = bounds ? downM * scale : whole(rowPitch * scale) * array.rows;
  return {
    left: Math.round(room.left + AXIS_LEFT + (width - mapWidth) / 2),
    top: Math.round(room.top + (height - mapHeight) / 2),
    width: mapWidth,
    height: mapHeight,
  };
}

/** Discs on a map: their middles and radii in pixels. */
function discsOn(area: Area, places: readonly FreePlace[]): FreePlace[] {
  const bounds = boundsOf(places);
  const scale = area.width / bounds.width;
  return places.map(([x, y, radius]) => [
    area.left + (x - bounds.left) * scale,
    area.top + (y - bounds.top) * scale,
    radius * scale,
  ]);
}

/** Discs as shares of the map: x, y and the radii across and down of each; empty where taxels are in a grid. */
export function sharesOf({ places }: ArrayDescription): Float32Array {
  if (places === undefined) return new Float32Array();
  const { left, top, width, height } = boundsOf(places);
  return Float32Array.from(
    places.flatMap(([x, y, radius]) => [(x - left) / width, (y - top) / height, radius / width, radius / height]),
  );
}

/** The rectangle of some taxels on a map. */
export function boxOf(area: Area, array: ArrayDescription, rows: Lines, cols: Lines): Area {
  if (array.places !== undefined) {
    const discs = discsOn(area, array.places);
    return boundsOf(discs.slice(rows[0] * array.cols + cols[0], rows[1] * array.cols + cols[1] + 1));
  }
  const [width, height] = [area.width / array.cols, area.height / array.rows];
  return {
    left: area.left + cols[0] * width,
    top: area.top + rows[0] * height,
    width: (cols[1] - cols[0] + 1) * width,
    height: (rows[1] - rows[0] + 1) * height,
  };
}

/** The rectangle of one taxel on a map. */
export function cellOf(area: Area, array: ArrayDescription, taxel: number): Area {
  const [row, col] = [Math.floor(taxel / array.cols), taxel % array.cols];
  return boxOf(area, array, [row, row], [col, col]);
}

/** The taxel at a place, row-major; -1 outside. */
export function taxelAt(area: Area, array: ArrayDescription, x: number, y: number): number {
  if (array.places !== undefined) {
    if (area.width === 0) return -1;
    return discsOn(area, array.places).findIndex(([left, top, radius]) => Math.hypot(x - left, y - top) <= radius);
  }
  const col = Math.floor(((x - area.left) / area.width) * array.cols);
  const row = Math.floor(((y - area.top) / area.height) * array.rows);
  const inside = col >= 0 && row >= 0 && col < array.cols && row < array.rows;
  return inside ? row * array.cols + col : -1;
}

/** A point of the plane of an array on a map: of taxels in no grid, between those that follow each other. */
export function pointOn(area: Area, array: ArrayDescription, xM: number, yM: number): readonly [number, number] {
  const [col, row] = [xM / array.pitch_m[1], yM / array.pitch_m[0]];
  if (array.places === undefined)
    return [area.left + ((col + 0.5) * area.width) / array.cols, area.top + ((row + 0.5) * area.height) / array.rows];
  const discs = discsOn(area, array.places);
  const along = Math.min(discs.length - 1, Math.max(0, array.rows === 1 ? col : row));
  const [before, after] = [discs[Math.floor(along)]!, discs[Math.ceil(along)]!];
  const share = along - Math.floor(along);
  return [before[0] + share * (after[0] - before[0]), before[1] + share * (after[1] - before[1])];
}

export function taxelName(taxel: number, array: ArrayDescription): string {
  return `r${Math.floor(taxel / array.cols)}c${taxel % array.cols}`;
}
