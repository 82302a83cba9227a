// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import uPlot from "uplot";
import { element, panel, setText } from "../../dom";
import { fixed } from "../../format";
import type { TimedEvent } from "../../live/event_log";
import { BIN_S, type ForceHistory } from "../../live/force_history";
import { cssColor } from "../../theme";
import { drawEvents } from "./event_marks";
import { linePath } from "./line_path";

const AXIS_FONT = '11px "Inter", "Segoe UI", Roboto, "Helvetica Neue", "Liberation Sans", Arial, sans-serif';
const ROUND_ENDS = [0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000];
const MOST_POINTS = 1000;

export interface Line {
  /** Asked again and again: which contact a line is of changes. */
  name: () => string;
  /** Name of a CSS variable. */
  color: string;
  history: ForceHistory;
}

/** Forces, or counts, over the last seconds: newest at the right, from 0 to a round end. */
export class ForcePlot {
  readonly element: HTMLElement;
  readonly #room = element("div", { class: "plot-room" });
  readonly #legend = element("ul", { class: "legend" });
  readonly #title = element("h2");
  readonly #unit = element("span", { class: "dim" });
  readonly #resizing = new ResizeObserver(() => this.#resize());
  #lines: readonly Line[] = [];
  #names: HTMLElement[] = [];
  #figures: HTMLElement[] = [];
  #plot: uPlot | undefined;
  #data: Float64Array[] = [];
  #windowS = 10;
  #endN = 1;
  #events: readonly TimedEvent[] = [];
  #nowS = 0;

  constructor(title: string, role: string) {
    this.element = panel(
      [this.#title, this.#unit, this.#legend],
      { class: "plot-panel", "data-role": role },
      this.#room,
    );
    this.setTitle(title, "N");
  }

  setTitle(title: string, unit: string): void {
    this.element.setAttribute("aria-label", title);
    setText(this.#title, title);
    setText(this.#unit, unit);
  }

  show(): void {
    this.#resizing.observe(this.#room);
  }

  hide(): void {
    this.#resizing.disconnect();
  }

  /** Also where the theme has changed. */
  setLines(lines: readonly Line[], windowS: number): void {
    this.#lines = lines;
    this.#windowS = windowS;
    const binsPerPoint = this.#binsPerPoint;
    const points = Math.round(windowS / BIN_S / binsPerPoint) + 1;
    const times = Float64Array.from({ length: points }, (_, point) => (point - points + 1) * BIN_S * binsPerPoint);
    this.#data = [times, ...lines.map(() => new Float64Array(points).fill(NaN))];
    this.#names = lines.map(() => element("span"));
    this.#figures = lines.map(() => element("span", { class: "figure" }));
    this.#legend.replaceChildren(
      ...lines.map(({ color }, index) =>
        element(
          "li",
          {},
          element("span", { class: "swatch", style: `background: var(${color})` }),
          this.#names[index]!,
          this.#figures[index]!,
        ),
      ),
    );
    this.#plot?.destroy();
    this.#plot = new uPlot(this.#options(), this.#data as unknown as uPlot.AlignedData, this.#room);
  }

  draw(endBin: number, events: readonly TimedEvent[]): void {
    if (this.#plot === undefined) return;
    this.#events = events;
    this.#nowS = endBin * BIN_S;
    this.#lines.forEach(({ history }, index) => history.copy(endBin, this.#binsPerPoint, this.#data[index + 1]!));
    this.#endN = this.#roundEnd();
    this.#plot.setData(this.#data as unknown as uPlot.AlignedData);
    this.#showFigures();
  }

  get #binsPerPoint(): number {
    return Math.ceil(this.#windowS / BIN_S / MOST_POINTS);
  }

  #roundEnd(): number {
    let highest = 0;
    for (let line = 1; line < this.#data.length; ++line) {
      for (const value of this.#data[line]!) if (value > highest) highest = value;
    }
    return ROUND_ENDS.find((end) => end >= 1.02 * highest) ?? highest;
  }

  /** At the cursor where there is one, else now; a line that is not there has no place in the legend. */
  #showFigures(): void {
    const point = this.#plot?.cursor.idx ?? this.#data[0]!.length - 1;
    this.#figures.forEach((figure, index) => {
      const value = this.#data[index + 1]![point]!;
      setText(figure, fixed(value, 2));
      setText(this.#names[index]!, this.#lines[index]!.name());
      figure.parentElement!.classList.toggle("absent", Number.isNaN(value));
    });
  }

  #resize(): void {
    const { clientWidth: width, clientHeight: height } = this.#room;
    if (width > 0 && height > 0) this.#plot?.setSize({ width, height });
  }

  #options(): uPlot.Options {
    const axis = {
      stroke: cssColor("--text-dim"),
      font: AXIS_FONT,
      grid: { stroke: cssColor("--line-faint"), width: 1 },
      ticks: { show: false },
    };
    return {
      width: Math.max(100, this.#room.clientWidth),
      height: Math.max(100, this.#room.clientHeight),
      legend: { show: false },
      padding: [10, 16, 0, 0],
      cursor: { y: false, points: { show: false }, drag: { x: false, y: false } },
      scales: { x: { time: false, range: () => [-this.#windowS, 0] }, y: { range: () => [0, this.#endN] } },
      axes: [
        {
          ...axis,
          size: 28,
          incrs: [1, 2, 5, 10],
          values: (_, ticks) => ticks.map((tick) => (tick === 0 ? "now" : `${fixed(tick, 0)} s`)),
        },
        { ...axis, size: 48, values: (_, ticks) => ticks.map((tick) => tick.toString()) },
      ],
      series: [
        {},
        ...this.#lines.map(({ color }) => ({
          stroke: cssColor(color),
          width: 1.5,
          paths: linePath,
          points: { show: false },
        })),
      ],
      hooks: { setCursor: [() => this.#showFigures()], draw: [(plot) => drawEvents(plot, this.#events, this.#nowS)] },
    };
  }
}
