// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { timeOfDay } from "../format";
import { type GridFrame, TaxelStatus } from "../messages/grids";
import { colorOf } from "../render/color_map";

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
