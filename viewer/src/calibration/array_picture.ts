// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { element } from "../dom";
import { CalibrationHint, CalibrationStage, type CalibrationState } from "../messages/calibration_state";
import { colorOf } from "../render/color_map";
import type { ArrayDescription } from "../suit";
import { cssColor } from "../theme";
import { cellOf, fitMap, taxelName } from "../views/array/geometry";

const FONT = '11px "Inter", "Segoe UI", Roboto, "Helvetica Neue", "Liberation Sans", Arial, sans-serif';
const LEAST_LABEL_PX = 16;
const [FIRST_COLOR, LAST_COLOR] = [0.42, 0.8]; // of the map; its ends are too near to the page, dark or light
const LEAST_NUMBER_PX = 18;
const RING_PX = 4;

type Area = ReturnType<typeof fitMap>;

function askedFor({ taxel, togetherWith }: CalibrationState): number[] {
  return togetherWith < 0 ? [taxel] : [taxel, togetherWith];
}

function colorOfTarget(taxel: number, { hint, missingTaxel }: CalibrationState): string {
  if (hint === CalibrationHint.release) return "--good";
  return taxel === missingTaxel ? "--warn" : "--accent";
}

/** The array: presses of each taxel in colour, the one or two that are asked for, and the one that is pressed instead. */
export class ArrayPicture {
  readonly element: HTMLElement;
  readonly #canvas = element("canvas", { class: "layer", role: "img" });
  readonly #resizing = new ResizeObserver(() => this.draw());
  #array: ArrayDescription | undefined;
  #state: CalibrationState | undefined;
  #planned: readonly number[] = [];

  constructor() {
    this.element = element("div", { class: "calibration-picture" }, this.#canvas);
  }

  show(): void {
    this.#resizing.observe(this.element);
  }

  hide(): void {
    this.#resizing.disconnect();
  }

  /** `planned`: taxels that are to be pressed. */
  set(array: ArrayDescription | undefined, state: CalibrationState | undefined, planned: readonly number[]): void {
    this.#array = array;
    this.#state = state;
    this.#planned = planned;
    this.draw();
  }

  draw(): void {
    const { clientWidth: width, clientHeight: height } = this.element;
    const context = this.#canvas.getContext("2d");
    if (this.#array === undefined || context === null || width === 0) return;
    const ratio = window.devicePixelRatio;
    this.#canvas.width = Math.round(width * ratio);
    this.#canvas.height = Math.round(height * ratio);
    context.scale(ratio, ratio);
    const area = fitMap({ left: 0, top: RING_PX, width: width - RING_PX, height: height - RING_PX }, this.#array);
    this.#drawPresses(context, area, this.#array);
    this.#drawNumbers(context, area, this.#array);
    this.#drawTarget(context, area, this.#array);
    this.#canvas.setAttribute("aria-label", this.#words(this.#array));
  }

  #words(array: ArrayDescription): string {
    const state = this.#state;
    const presses = state?.taxelPresses.reduce((sum, count) => sum + count, 0) ?? 0;
    const target =
      state?.stage === CalibrationStage.pressing
        ? `; press ${askedFor(state)
            .map((taxel) => taxelName(taxel, array))
            .join(" and ")}`
        : "";
    return `${array.rows} rows, ${array.cols} columns, ${presses} presses${target}`;
  }

  #drawPresses(context: CanvasRenderingContext2D, area: Area, array: ArrayDescription): void {
    const presses = this.#state?.taxelPresses;
    const most = Math.max(1, ...(presses ?? []));
    const gap = Math.min(2, 0.1 * cellOf(area, array, 0).width);
    context.font = FONT;
    context.textAlign = "center";
    context.textBaseline = "middle";
    for (let taxel = 0; taxel < array.rows * array.cols; ++taxel) {
      const count = presses?.[taxel] ?? 0;
      context.fillStyle =
        count === 0
          ? cssColor("--raised")
          : colorOf(FIRST_COLOR + (LAST_COLOR - FIRST_COLOR) * ((count - 1) / Math.max(1, most - 1)));
      const { left, top, width, height } = cellOf(area, array, taxel);
      context.fillRect(left, top, width - gap, height - gap);
      if (count === 0 || Math.min(width, height) < LEAST_NUMBER_PX) continue;
      context.fillStyle = count > 0.6 * most && most > 1 ? "#12171c" : "#ffffff";
      context.fillText(String(count), left + 0.5 * (width - gap), top + 0.5 * (height - gap));
    }
    context.strokeStyle = cssColor("--control-line");
    context.lineWidth = 1.5;
    for (const taxel of this.#planned) {
      if ((presses?.[taxel] ?? 0) > 0) continue;
      const { left, top, width, height } = cellOf(area, array, taxel);
      context.strokeRect(left + 1, top + 1, width - gap - 2, height - gap - 2);
    }
  }

  #drawNumbers(context: CanvasRenderingContext2D, area: Area, { rows, cols, places }: ArrayDescription): void {
    if (places !== undefined) return;
    const [cellWidth, cellHeight] = [area.width / cols, area.height / rows];
    context.font = FONT;
    context.fillStyle = cssColor("--text-dim");
    context.textBaseline = "middle";
    context.textAlign = "right";
    const rowStep = Math.ceil(LEAST_LABEL_PX / cellHeight);
    for (let row = 0; row < rows; row += rowStep) {
      context.fillText(String(row), area.left - 6, area.top + (row + 0.5) * cellHeight);
    }
    context.textAlign = "center";
    const colStep = Math.ceil(LEAST_LABEL_PX / cellWidth);
    for (let col = 0; col < cols; col += colStep) {
      context.fillText(String(col), area.left + (col + 0.5) * cellWidth, area.top + area.height + 10);
    }
  }

  #drawTarget(context: CanvasRenderingContext2D, area: Area, array: ArrayDescription): void {
    const state = this.#state;
    if (state === undefined || state.stage !== CalibrationStage.pressing) return;
    const wrong = state.hint === CalibrationHint.otherTaxel || state.hint === CalibrationHint.several;
    if (wrong && state.pressedTaxel >= 0) this.#ring(context, area, array, state.pressedTaxel, "--bad", true);
    for (const taxel of askedFor(state)) this.#ring(context, area, array, taxel, colorOfTarget(taxel, state), false);
  }

  /** Around a taxel, and its row and column as faint lines, so that it is found on the array; or crossed out. */
  #ring(
    context: CanvasRenderingContext2D,
    area: Area,
    array: ArrayDescription,
    taxel: number,
    color: string,
    crossed: boolean,
  ): void {
    const { left, top, width, height } = cellOf(area, array, taxel);
    context.strokeStyle = cssColor(color);
    if (!crossed && array.places === undefined) {
      context.lineWidth = 1;
      context.setLineDash([3, 3]);
      context.strokeRect(area.left, top, area.width, height);
      context.strokeRect(left, area.top, width, area.height);
      context.setLineDash([]);
    }
    context.lineWidth = RING_PX;
    context.strokeRect(left - 1, top - 1, width, height);
    if (!crossed) return;
    context.beginPath();
    context.moveTo(left, top);
    context.lineTo(left + width - 2, top + height - 2);
    context.moveTo(left + width - 2, top);
    context.lineTo(left, top + height - 2);
    context.stroke();
  }
}
