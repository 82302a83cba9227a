// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import type { Area } from "../../render/heat_maps";
import type { ArrayDescription } from "../../suit";
import { cssColor } from "../../theme";

const FONT = '11px "Inter", "Segoe UI", Roboto, "Helvetica Neue", "Liberation Sans", Arial, sans-serif';
const PIXELS_A_LABEL = 26;
const STEPS = [1, 2, 4, 5, 10, 20, 50, 100, 200];

function stepOf(cellPixels: number): number {
  return STEPS.find((step) => step * cellPixels >= PIXELS_A_LABEL) ?? 500;
}

/** The numbers of rows and columns beside the maps; of a grid. */
export function drawAxes(
  canvas: HTMLCanvasElement,
  areas: readonly Area[],
  array: ArrayDescription,
  pixelRatio: number,
): void {
  const pen = canvas.getContext("2d")!;
  pen.resetTransform();
  pen.clearRect(0, 0, canvas.width, canvas.height);
  pen.scale(pixelRatio, pixelRatio);
  pen.font = FONT;
  pen.fillStyle = cssColor("--text-dim");
  if (array.places !== undefined) return;
  for (const area of areas) {
    if (area.width === 0) continue;
    const width = area.width / array.cols;
    const height = area.height / array.rows;
    pen.textAlign = "right";
    pen.textBaseline = "middle";
    for (let row = 0; row < array.rows; row += stepOf(height)) {
      pen.fillText(String(row), area.left - 6, area.top + (row + 0.5) * height);
    }
    pen.textAlign = "center";
    pen.textBaseline = "top";
    for (let col = 0; col < array.cols; col += stepOf(width)) {
      pen.fillText(String(col), area.left + (col + 0.5) * width, area.top + area.height + 5);
    }
  }
}
