// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { element, setHidden, setText } from "../dom";
import { errorText } from "../format";
import type { Stream } from "../stream/stream";
import type { Suit } from "../suit";
import type { Theme } from "../theme";
import { CornerGuide } from "./corner_guide";
import { dumpOf } from "./first_bytes";
import { KnownArrays } from "./known_arrays";
import { LayoutChoice } from "./layout_choice";
import { LivePicture } from "./live_picture";
import { PressGuide } from "./press_guide";
import { makeSourceChoice } from "./source_choice";
import { type Shape, TouchFeed } from "./touch_feed";
import "./setup.css";

const LINES = { type: "number", min: 1, max: 1024, step: 1, required: true } as const;
/** Who types a number has not finished with its first digit. */
const TYPING_MS = 500;

/** Asks where the array is and how it is made, where nothing is written of it yet: a part of the page for each. */
export function makeArraySetup(stream: Stream, suit: Suit, theme: Theme): HTMLElement[] {
  const known = new KnownArrays(stream);
  const choice = makeSourceChoice(stream, known);
  const feed = new TouchFeed(stream);
  const picture = new LivePicture(theme);
  const source = element("p", { class: "dim" });
  const found = element("p", { "data-role": "found" });
  const bytes = element("pre", {
    class: "first-bytes",
    tabindex: 0,
    "aria-label": "The first bytes",
    "data-role": "first-bytes",
    hidden: true,
  });
  const problem = element("p", { class: "attention", role: "alert", "data-role": "setup-problem", hidden: true });
  const name = element("input", {
    id: "array-name",
    class: "field",
    value: "mat",
    pattern: "[A-Za-z0-9_\\-]+",
    required: true,
    autocomplete: "off",
  });
  const rows = element("input", { id: "array-rows", class: "field", ...LINES });
  const cols = element("input", { id: "array-cols", class: "field", ...LINES });
  const pitch = element("input", {
    id: "array-pitch",
    class: "field",
    type: "number",
    min: 0.05,
    max: 1000,
    step: "any",
    value: 10,
    required: true,
  });
  const bits = element("input", {
    id: "array-bits",
    class: "field",
    type: "number",
    min: 1,
    max: 24,
    step: 1,
    value: 12,
    required: true,
  });

  const tell = (words: string): void => {
    setText(problem, words);
    setHidden(problem, false);
  };

  /** Rows and columns are those of the array, which may not be those that are sent. */
  let isSwapped = false;
  const swapLines = (transpose: boolean): void => {
    if (transpose !== isSwapped) [rows.value, cols.value] = [cols.value, rows.value];
    isSwapped = transpose;
  };
  const sentShape = (): Shape | undefined => {
    if (!rows.checkValidity() || !cols.checkValidity()) return undefined;
    const [first, second] = isSwapped ? [cols, rows] : [rows, cols];
    return { rows: first.valueAsNumber, cols: second.valueAsNumber };
  };
  const twoCorners = (): Shape | undefined => {
    const shape = sentShape();
    return shape !== undefined && shape.rows > 1 && shape.cols > 1 ? shape : undefined;
  };
  const corners = new CornerGuide(feed, twoCorners, ({ transpose }) => swapLines(transpose));
  const presses = new PressGuide(
    stream,
    sentShape,
    () => {
      feed.stop();
      picture.forget();
    },
    () => void ask("/array/arrange", { name: name.value }),
  );
  const watch = (): void => {
    presses.forget();
    picture.forget();
    const shape = sentShape();
    if (shape === undefined || !stream.services.value.has("/array/watch")) feed.stop();
    else void feed.watch(shape);
  };
  const submit = element("button", { class: "button primary large-button", type: "submit" }, "Show it");
  // They come after the description.
  stream.services.follow((services) => {
    submit.disabled = !services.has("/array/describe");
    watch();
  });
  /** The guide to the corners has begun meanwhile: its rest must not be learned anew while somebody presses. */
  const isWatched = (): boolean => {
    const [shape, watched] = [sentShape(), feed.shape];
    return shape !== undefined && shape.rows === watched?.rows && shape.cols === watched.cols;
  };
  let typing = 0;
  for (const input of [rows, cols]) {
    input.addEventListener("input", () => {
      isSwapped = false;
      corners.forget();
      window.clearTimeout(typing);
      areTyped = true;
      typing = window.setTimeout(() => {
        if (!isWatched()) watch();
        propose();
      }, TYPING_MS);
    });
  }
  feed.latest.follow((touch) => {
    if (touch === undefined || feed.shape === undefined) return;
    picture.show(touch, feed.shape, corners.way);
    if (touch.problem !== "") tell(touch.problem);
  });

  /** Calls a service; an error in its answer is shown, and the question stays. */
  async function ask(service: string, request: object): Promise<void> {
    setHidden(problem, true);
    try {
      await stream.callService(service, request);
    } catch (error) {
      tell(errorText(error));
    }
  }
  /** Rows and columns that a person typed are asked of the bytes. */
  let areTyped = false;
  const layouts = new LayoutChoice(
    stream,
    theme,
    (proposal) => {
      if (!areTyped) [rows.value, cols.value] = [String(proposal.rows), String(proposal.cols)];
    },
    (request) => void ask("/layout/use", { ...request, name: name.value }).then(() => stream.refresh()),
  );
  const propose = (): void => {
    if (suit.description.value.setup?.readable !== false || suit.description.value.setup.bytes === "") return;
    const shape = areTyped ? sentShape() : undefined;
    layouts.propose(shape ?? {}).catch((error: unknown) => tell(errorText(error)));
  };
  stream.services.follow(propose);
  const use = async (file: string): Promise<void> => {
    window.clearTimeout(typing);
    await ask("/array/use", { file });
  };
  const again = element("button", { class: "button", type: "button", "data-role": "listen-again" }, "Listen again");
  again.addEventListener("click", () => {
    feed.stop();
    again.disabled = true;
    void ask("/source/look", {}).then(async () => {
      await stream.refresh();
      again.disabled = false;
    });
  });
  const leave = element("button", { class: "button", type: "button", "data-role": "other-source" }, "Another source");
  leave.addEventListener("click", () => {
    feed.stop();
    known.chosen.value = undefined;
    void ask("/source/leave", {}).then(() => stream.refresh());
  });

  const field = (words: string, input: HTMLElement): HTMLElement[] => [
    element("label", { for: input.id }, words),
    input,
  ];
  const form = element(
    "form",
    { class: "panel array-setup", "data-role": "array-setup", "aria-label": "The array", hidden: true },
    element("h2", {}, "Which array is this?"),
    source,
    found,
    bytes,
    layouts.element,
    element("div", { class: "setup-row" }, again, leave),
    known.makeList(({ file }) => void use(file)),
    ...field("Name", name),
    ...field("Rows", rows),
    ...field("Columns", cols),
    picture.element,
    corners.element,
    presses.element,
    ...field("From taxel to taxel [mm]", pitch),
    ...field("Bits of the ADC (10: Arduino Uno, 12: ESP32)", bits),
    element("p", { class: "dim" }, "This becomes an array.toml. The circuit is found by the calibration."),
    problem,
    submit,
  );
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    const request = {
      name: name.value,
      rows: rows.valueAsNumber,
      cols: cols.valueAsNumber,
      pitch_um: Math.round(1000 * pitch.valueAsNumber),
      adc_bits: bits.valueAsNumber,
      ...corners.way,
    };
    window.clearTimeout(typing);
    void ask("/array/describe", request);
  });
  known.all.follow(() => {
    if (name.value === name.defaultValue) name.value = name.defaultValue = known.freeName();
  });
  /** Comes again with each connection: what a person has typed stays. */
  let asked = "";
  suit.description.follow(({ setup }) => {
    const question = JSON.stringify([setup?.from, setup?.readable, setup?.rows, setup?.cols, setup?.layout]);
    const isNew = question !== asked;
    asked = question;
    setHidden(choice, setup?.from !== "");
    setHidden(form, setup === undefined || setup.from === "");
    window.clearTimeout(typing);
    feed.stop();
    if (setup === undefined || setup.from === "") return;
    setText(source, setup.from);
    setText(found, setup.message);
    found.classList.toggle("attention", !setup.readable);
    setText(bytes, dumpOf(setup.bytes));
    setHidden(bytes, setup.bytes === "");
    setHidden(again, setup.readable);
    setHidden(leave, !stream.services.value.has("/source/leave"));
    for (const guide of [corners, presses]) setHidden(guide.element, !setup.turnable);
    if (isNew) {
      [rows.value, cols.value] = [String(setup.rows ?? ""), String(setup.cols ?? "")];
      isSwapped = areTyped = false;
      corners.forget();
      layouts.forget();
      setHidden(problem, true);
    }
    propose();
    if (known.chosen.value !== undefined) void use(known.chosen.value.file);
    else watch();
  });
  return [choice, form];
}
