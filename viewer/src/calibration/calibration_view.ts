// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { button, element, panel, setHidden, setText } from "../dom";
import { errorText } from "../format";
import {
  CalibrationHint,
  CalibrationStage,
  type CalibrationState,
  readCalibrationState,
} from "../messages/calibration_state";
import type { ArrayDescription } from "../suit";
import type { View, ViewContext, ViewFactory } from "../view";
import { ArrayPicture } from "./array_picture";
import { Beep } from "./beep";
import "./calibration.css";
import type { StartRequest } from "./plan";
import { SetupForm } from "./setup_form";
import { WalkPanel } from "./walk_panel";

const HIGH_HZ = 880;
const LOW_HZ = 220;

/** Walks a person through a calibration: which taxel, which weight, how far, how good; and takes the model into use. */
class CalibrationView implements View {
  readonly name = "calibration";
  readonly title = "Calibration";
  readonly element: HTMLElement;
  readonly #context: ViewContext;
  readonly #picture = new ArrayPicture();
  readonly #setup = new SetupForm(
    (request) => this.#start(request),
    () => this.#draw(),
  );
  readonly #walk = new WalkPanel({
    skip: () => this.#call("skip"),
    repeat: () => this.#call("repeat"),
    finish: () => this.#call("finish"),
    save: () => this.#call("save"),
    cancel: () => this.#cancel(),
  });
  readonly #title = element("h2", {}, "Presses of each taxel");
  readonly #problem = element("p", {
    class: "calibration-problem",
    role: "alert",
    "data-role": "problem",
    hidden: true,
  });
  readonly #sure = element("dialog", { class: "dialog", "aria-label": "Cancel the calibration", "data-role": "sure" });
  readonly #beep = new Beep();
  #state: CalibrationState | undefined;
  /** Taxels of the calibration that was begun on this page. */
  #planned: readonly number[] = [];
  #unfollow: (() => void)[] = [];

  constructor(context: ViewContext) {
    this.#context = context;
    this.element = element(
      "div",
      { class: "view calibration-view", "data-view": "calibration" },
      panel([this.#title], { class: "calibration-array", "aria-label": "Array" }, this.#picture.element),
      element(
        "section",
        { class: "panel calibration-side", "aria-label": "Guide" },
        this.#problem,
        this.#setup.element,
        this.#walk.element,
      ),
      this.#sure,
    );
    this.#sure.append(
      element("p", {}, "Forget all presses of this calibration?"),
      element(
        "form",
        { method: "dialog" },
        element("button", { class: "button" }, "Go on"),
        " ",
        button("Forget them", () => this.#call("cancel"), { class: "primary", "data-role": "forget", type: "submit" }),
      ),
    );
  }

  show(): void {
    const { stream, suit, theme } = this.#context;
    this.#picture.show();
    this.#unfollow = [
      stream.subscribe("/calibration", (message) => this.#receive(readCalibrationState(message))),
      stream.services.follow(() => this.#draw()),
      stream.connection.follow(({ kind }) => {
        if (kind !== "live") this.#receive(undefined);
      }),
      suit.selected.follow(() => this.#draw()),
      theme.shown.follow(() => this.#picture.draw()),
    ];
  }

  hide(): void {
    this.#picture.hide();
    for (const unfollow of this.#unfollow) unfollow();
  }

  key(event: KeyboardEvent): boolean {
    const action = { n: "skip", b: "repeat" }[event.key];
    const stage = this.#state?.stage;
    if (action !== undefined && stage === CalibrationStage.pressing) this.#call(action);
    else if (event.key === "Enter" && stage === CalibrationStage.done && !(event.target instanceof HTMLButtonElement))
      this.#call("save");
    else return false;
    return true;
  }

  #receive(state: CalibrationState | undefined): void {
    this.#sound(this.#state, state);
    if (state === undefined || state.stage === CalibrationStage.none) this.#walk.plot.clear();
    this.#state = state?.stage === CalibrationStage.none ? undefined : state;
    this.#draw();
  }

  #sound(before: CalibrationState | undefined, now: CalibrationState | undefined): void {
    if (now === undefined || before?.hint === now.hint) return;
    if (now.hint === CalibrationHint.release) this.#beep.play(HIGH_HZ);
    if (now.hint === CalibrationHint.otherTaxel || now.hint === CalibrationHint.tooShort) this.#beep.play(LOW_HZ);
  }

  #array(): ArrayDescription | undefined {
    const { description, selected } = this.#context.suit;
    if (this.#state === undefined) return selected.value;
    return description.value.arrays.find(({ name }) => name === this.#state?.array);
  }

  #draw(): void {
    const array = this.#array();
    setText(this.#title, `Presses of each taxel of ${array?.name ?? ""}`);
    setHidden(this.#setup.element, this.#state !== undefined);
    setHidden(this.#walk.element, this.#state === undefined);
    if (this.#state === undefined)
      this.#setup.set(array, this.#context.stream.services.value.has("/calibration/start"));
    else this.#walk.set(this.#state, array);
    this.#picture.set(array, this.#state, this.#state === undefined ? this.#setup.taxels : this.#planned);
  }

  #start(request: StartRequest): void {
    this.#beep.allow();
    this.#walk.plot.clear();
    this.#planned = this.#setup.taxels;
    this.#call("start", request);
  }

  /** A slip must not lose finished presses; saved or not begun ones are safe. */
  #cancel(): void {
    if (this.#state?.stage === CalibrationStage.pressing && this.#state.pressesDone > 0) this.#sure.showModal();
    else this.#call("cancel");
  }

  #call(service: string, request: object = {}): void {
    setHidden(this.#problem, true);
    this.#context.stream.callService(`/calibration/${service}`, request).catch((error: unknown) => {
      setText(this.#problem, errorText(error));
      setHidden(this.#problem, false);
    });
  }
}

export const createCalibrationView: ViewFactory = (context) => new CalibrationView(context);
