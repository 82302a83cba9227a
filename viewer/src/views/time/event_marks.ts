// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import type uPlot from "uplot";
import { EVENT_KINDS, type EventKind, type TimedEvent } from "../../live/event_log";
import { cssColor } from "../../theme";

/** The name of each kind in the toolbar, and the CSS variable of its colour. */
export const EVENT_LOOKS: Readonly<Record<EventKind, { words: string; color: string }>> = {
  threat: { words: "threats", color: "--bad" },
  contact: { words: "contacts begin", color: "--control-line" },
  tare: { words: "tare", color: "--accent" },
  mark: { words: "marks of your own", color: "--text" },
};

const FONT = '11px "Inter", "Segoe UI", Roboto, "Helvetica Neue", "Liberation Sans", Arial, sans-serif';
const GAP = 4;

/** A line at the moment of each event, with its words where there is room. `nowS`: the time of the right edge. */
export function drawEvents(plot: uPlot, events: readonly TimedEvent[], nowS: number): void {
  const pen = plot.ctx;
  const ratio = plot.width > 0 ? plot.ctx.canvas.width / plot.width : 1;
  const { left, top, width, height } = plot.bbox;
  const firstS = plot.scales.x?.min ?? 0;
  const colors = Object.fromEntries(EVENT_KINDS.map((kind) => [kind, cssColor(EVENT_LOOKS[kind].color)]));
  pen.save();
  pen.scale(ratio, ratio);
  pen.font = FONT;
  pen.fillStyle = cssColor("--text");
  pen.textAlign = "left";
  pen.textBaseline = "top";
  let free = Infinity;
  for (let index = events.length - 1; index >= 0; --index) {
    const { kind, atS, words } = events[index]!;
    const ageS = atS - nowS;
    if (ageS < firstS || ageS > 0) continue;
    const x = (left + width * (1 - ageS / firstS)) / ratio;
    pen.strokeStyle = colors[kind]!;
    pen.setLineDash(kind === "contact" ? [2, 3] : []);
    pen.beginPath();
    pen.moveTo(x, top / ratio);
    pen.lineTo(x, (top + height) / ratio);
    pen.stroke();
    const end = x + GAP + pen.measureText(words).width;
    if (end < Math.min(free, (left + width) / ratio)) pen.fillText(words, x + GAP, top / ratio);
    free = x - GAP;
  }
  pen.restore();
}
