// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import type { Area } from "../../render/heat_maps";
import type { ArrayDescription } from "../../suit";

/** Around a map, for the numbers of its rows and columns. */
export const AXIS_LEFT = 26;
export const AXIS_BOTTOM = 18;

const SMALLEST_WHOLE_CELL = 4;

/** The largest place inside `room` with the proportions of the array, and cells of whole pixels. */
export function fitMap(room: Area, array: ArrayDescription): Area {
  const width = Math.max(1, room.width - AXIS_LEFT);
  const height = Math.max(1, room.height - AXIS_BOTTOM);
  const [rowPitch, colPitch] = array.pitch_m;
  const scale = Math.min(width / (array.cols * colPitch), height / (array.rows * rowPitch));
  const whole = (pixels: number): number => (pixels >= SMALLEST_WHOLE_CELL ? Math.floor(pixels) : pixels);
  const mapWidth = whole(colPitch * scale) * array.cols;
  const mapHeight = whole(rowPitch * scale) * array.rows;
  return {
    left: Math.round(room.left + AXIS_LEFT + (width - mapWidth) / 2),
    top: Math.round(room.top + (height - mapHeight) / 2),
    width: mapWidth,
    height: mapHeight,
  };
}

/** The taxel at a place, row-major; -1 outside. */
export function taxelAt(area: Area, array: ArrayDescription, x: number, y: number): number {
  const col = Math.floor(((x - area.left) / area.width) * array.cols);
  const row = Math.floor(((y - area.top) / area.height) * array.rows);
  const inside = col >= 0 && row >= 0 && col < array.cols && row < array.rows;
  return inside ? row * array.cols + col : -1;
}

export function taxelName(taxel: number, array: ArrayDescription): string {
  return `r${Math.floor(taxel / array.cols)}c${taxel % array.cols}`;
}
