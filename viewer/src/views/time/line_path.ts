// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import type uPlot from "uplot";

/** Straight lines with a gap where a value is NaN; uPlot itself knows gaps as null, which would box every number. */
export const linePath: uPlot.Series.PathBuilder = (plot, seriesIndex, first, last) => {
  const stroke = new Path2D();
  const xs = plot.data[0];
  const ys = plot.data[seriesIndex]!;
  const scaleX = plot.scales.x!;
  const scaleY = plot.scales.y!;
  const { left, top, width, height } = plot.bbox;
  const perX = width / (scaleX.max! - scaleX.min!);
  const perY = height / (scaleY.max! - scaleY.min!);
  let isDrawing = false;
  for (let index = first; index <= last; ++index) {
    const value = ys[index]!;
    if (Number.isNaN(value)) {
      isDrawing = false;
      continue;
    }
    const x = left + (xs[index]! - scaleX.min!) * perX;
    const y = top + height - (value - scaleY.min!) * perY;
    if (isDrawing) stroke.lineTo(x, y);
    else stroke.moveTo(x, y);
    isDrawing = true;
  }
  return { stroke, fill: null, clip: null };
};
