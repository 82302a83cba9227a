// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { button, element, setData, setHidden, setText } from "../dom";
import { fixed } from "../format";
import { CalibrationHint, CalibrationStage, type CalibrationState } from "../messages/calibration_state";
import type { ArrayDescription } from "../suit";
import { taxelName } from "../views/array/geometry";
import { HoldRing } from "./hold_ring";
import { inGrams } from "./plan";
import { QualityPlot } from "./quality_plot";
import { ReadingBar } from "./reading_bar";

export interface WalkActions {
  skip(): void;
  repeat(): void;
  finish(): void;
  save(): void;
  cancel(): void;
}

function percent(value: number): string {
  return `${fixed(100 * value, value < 0.1 ? 1 : 0)} %`;
}

function levelOf({ stage, hint }: CalibrationState): "good" | "warn" | "bad" | "" {
  if (stage === CalibrationStage.failed) return "bad";
  if (stage === CalibrationStage.done) return "good";
  if (stage !== CalibrationStage.pressing) return "";
  if (hint === CalibrationHint.release) return "good";
  return hint >= CalibrationHint.otherTaxel && hint !== CalibrationHint.oneOfTwo ? "warn" : "";
}

/** The next action, the progress and the quality. */
export class WalkPanel {
  readonly element: HTMLElement;
  readonly plot = new QualityPlot();
  readonly #progress = element("progress", { "aria-label": "Presses", "data-role": "progress", max: 1, value: 0 });
  readonly #count = element("span", { class: "figure", "data-role": "count" });
  readonly #words = element("p", {
    class: "instruction",
    role: "status",
    "aria-live": "assertive",
    "data-role": "instruction",
  });
  readonly #ring = new HoldRing();
  readonly #reading = new ReadingBar();
  readonly #togetherReading = new ReadingBar();
  readonly #readings: HTMLElement;
  readonly #quality = element("span", { class: "quality-figure", "data-role": "quality" });
  readonly #unpressed = element("p", { class: "dim", "data-role": "unpressed" });
  readonly #pressing: HTMLElement;
  readonly #skip: HTMLButtonElement;
  readonly #repeat: HTMLButtonElement;
  readonly #finish: HTMLButtonElement;
  readonly #save: HTMLButtonElement;
  readonly #cancel: HTMLButtonElement;

  constructor(actions: WalkActions) {
    this.#skip = button("Skip", () => actions.skip(), { "data-role": "skip", title: "Key N" });
    this.#repeat = button("Last one again", () => actions.repeat(), { "data-role": "repeat", title: "Key B" });
    this.#finish = button("Finish now", () => actions.finish(), { "data-role": "finish" });
    this.#save = button("Save and use", () => actions.save(), {
      class: "primary",
      "data-role": "save",
      title: "Key Enter",
    });
    this.#cancel = button("Cancel", () => actions.cancel(), { "data-role": "cancel" });
    this.#readings = element("div", { class: "readings" }, this.#reading.element, this.#togetherReading.element);
    this.#pressing = element("div", { class: "pressing" }, this.#ring.element, this.#readings);
    this.element = element(
      "div",
      { class: "calibration-walk", "data-role": "walk" },
      element("div", { class: "walk-progress" }, this.#progress, this.#count),
      this.#words,
      this.#pressing,
      element(
        "section",
        { class: "quality", "aria-label": "Quality of the fit so far" },
        element(
          "div",
          { class: "reading-head" },
          element("h2", {}, "Error on presses the fit did not see"),
          this.#quality,
        ),
        this.plot.element,
        this.#unpressed,
      ),
      element(
        "div",
        { class: "walk-buttons" },
        this.#save,
        this.#skip,
        this.#repeat,
        this.#finish,
        element("span", { class: "stretch" }),
        this.#cancel,
      ),
    );
  }

  set(state: CalibrationState, array: ArrayDescription | undefined): void {
    const { stage } = state;
    const isFitting = stage === CalibrationStage.fitting;
    this.#progress.max = isFitting ? 1 : Math.max(1, state.pressesTotal);
    this.#progress.value = isFitting ? state.holdShare : state.pressesDone;
    setText(
      this.#count,
      isFitting ? `fit, ${fixed(100 * state.holdShare, 0)} %` : `${state.pressesDone} of ${state.pressesTotal}`,
    );
    this.#say(state);
    setData(this.#words, "level", levelOf(state));
    setData(this.element, "stage", String(stage));
    this.#setPress(state, array);
    this.plot.add(state.pressesDone, state.pressesTotal, state.medianRelativeError);
    const isKnown = !Number.isNaN(state.medianRelativeError);
    setText(this.#quality, isKnown ? percent(state.medianRelativeError) : "after some presses");
    this.#quality.classList.toggle("dim", !isKnown);
    setText(
      this.#unpressed,
      Number.isNaN(state.unpressedRelativeError)
        ? ""
        : `On taxels that were not pressed: about ${percent(state.unpressedRelativeError)}`,
    );
    this.#setButtons(state);
  }

  /** The result has several sentences and is shown a line each. */
  #say({ stage, message }: CalibrationState): void {
    const isResult = stage === CalibrationStage.done;
    const lines = isResult ? message.split(/(?<=\.) (?=[A-Z0-9])/) : [message];
    if (this.#words.dataset.message === message) return;
    this.#words.dataset.message = message;
    this.#words.replaceChildren(...lines.flatMap((line) => [element("span", {}, line), " "]));
  }

  #setPress(state: CalibrationState, array: ArrayDescription | undefined): void {
    const isPressing = state.stage === CalibrationStage.pressing;
    const isPair = state.togetherWith >= 0;
    setHidden(this.#pressing, !isPressing && state.stage !== CalibrationStage.unloaded);
    if (isPressing)
      this.#ring.set(
        state.holdShare,
        `${Number(state.weightN.toPrecision(4))} N`,
        inGrams(state.weightN) + (isPair ? " each" : ""),
      );
    else this.#ring.set(state.holdShare, "0 N", "nothing");
    setHidden(this.#readings, !isPressing);
    setHidden(this.#togetherReading.element, !isPair);
    if (array === undefined) return;
    this.#reading.set(taxelName(state.taxel, array), state.reading);
    if (isPair) this.#togetherReading.set(taxelName(state.togetherWith, array), state.togetherReading);
  }

  #setButtons({ stage, pressesDone, message }: CalibrationState): void {
    const isPressing = stage === CalibrationStage.pressing;
    const isOver = stage === CalibrationStage.done || stage === CalibrationStage.failed;
    const isFitting = stage === CalibrationStage.fitting;
    setHidden(this.#skip, isOver || isFitting);
    setHidden(this.#finish, isOver || isFitting);
    setHidden(this.#save, !isOver);
    setHidden(this.#repeat, isFitting || stage === CalibrationStage.done);
    this.#skip.disabled = !isPressing;
    this.#finish.disabled = !isPressing || pressesDone === 0;
    this.#repeat.disabled = pressesDone === 0 || (!isPressing && stage !== CalibrationStage.failed);
    this.#save.disabled = message.includes("Saved as");
    setText(this.#save, stage === CalibrationStage.failed ? "Save what was measured" : "Save and use");
    setText(this.#cancel, stage === CalibrationStage.done ? "Close" : "Cancel");
  }
}
