// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { element, setHidden, setText } from "../dom";
import type { Stream } from "../stream/stream";
import type { Suit } from "../suit";
import { CornerGuide } from "./corner_guide";
import { makePortList } from "./port_list";

const LINES = { type: "number", min: 1, max: 1024, step: 1, required: true } as const;

/** Asks where the array is and how it is made, where nothing is written of it yet: a part of the page for each. */
export function makeArraySetup(stream: Stream, suit: Suit): HTMLElement[] {
  const ports = makePortList(stream);
  const source = element("p", { class: "dim" });
  const found = element("p", { "data-role": "found" });
  const problem = element("p", { class: "attention", role: "alert", "data-role": "setup-problem", hidden: true });
  const name = element("input", { id: "array-name", class: "field", value: "mat", pattern: "[A-Za-z0-9_\\-]+", required: true, autocomplete: "off" });
  const rows = element("input", { id: "array-rows", class: "field", ...LINES });
  const cols = element("input", { id: "array-cols", class: "field", ...LINES });
  const pitch = element("input", { id: "array-pitch", class: "field", type: "number", min: 0.05, max: 1000, step: "any", value: 10, required: true });
  const bits = element("input", { id: "array-bits", class: "field", type: "number", min: 1, max: 24, step: 1, value: 12, required: true });

  /** Rows and columns are those of the array, which may not be those that are sent. */
  let isSwapped = false;
  const swapLines = (transpose: boolean): void => {
    if (transpose !== isSwapped) [rows.value, cols.value] = [cols.value, rows.value];
    isSwapped = transpose;
  };
  const sentShape = (): { rows: number; cols: number } | undefined => {
    const isKnown = rows.checkValidity() && cols.checkValidity() && rows.valueAsNumber > 1 && cols.valueAsNumber > 1;
    return isKnown ? { rows: rows.valueAsNumber, cols: cols.valueAsNumber } : undefined;
  };
  const corners = new CornerGuide(stream, sentShape, ({ transpose }) => swapLines(transpose));
  for (const input of [rows, cols]) {
    input.addEventListener("input", () => {
      isSwapped = false;
      corners.forget();
    });
  }

  const field = (words: string, input: HTMLElement): HTMLElement[] => [element("label", { for: input.id }, words), input];
  const form = element(
    "form",
    { class: "panel array-setup", "data-role": "array-setup", "aria-label": "The array", hidden: true },
    element("h2", {}, "Which array is this?"),
    source,
    found,
    ...field("Name", name),
    ...field("Rows", rows),
    ...field("Columns", cols),
    corners.element,
    ...field("From taxel to taxel [mm]", pitch),
    ...field("Bits of the ADC (10: Arduino Uno, 12: ESP32)", bits),
    element("p", { class: "dim" }, "This becomes an array.toml. The circuit is found by the calibration."),
    problem,
    element("button", { class: "button primary large-button", type: "submit" }, "Show it"),
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
    setHidden(problem, true);
    stream.callService("/array/describe", request).catch((error: unknown) => {
      setText(problem, error instanceof Error ? error.message : String(error));
      setHidden(problem, false);
    });
  });
  suit.description.follow(({ setup }) => {
    setHidden(ports, setup?.from !== "");
    setHidden(form, setup === undefined || setup.from === "");
    if (setup === undefined) return;
    setText(source, setup.from);
    setText(found, setup.message);
    rows.value = setup.rows === null ? "" : String(setup.rows);
    cols.value = setup.cols === null ? "" : String(setup.cols);
    isSwapped = false;
    corners.forget();
  });
  return [ports, form];
}
