// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { element, setText } from "../dom";
import type { Stream } from "../stream/stream";
import "./thresholds.css";

interface Field {
  name: string;
  label: string;
  unit: string;
  min: number;
  step: number;
}

const FIELDS: readonly Field[] = [
  { name: "/contacts/onset_sigma", label: "A contact begins above", unit: "\u03c3", min: 0, step: 0.5 },
  { name: "/contacts/onset_force_n", label: "and above", unit: "N", min: 0, step: 0.05 },
  { name: "/contacts/release_share", label: "and ends below this share of both", unit: "", min: 0, step: 0.05 },
  { name: "/stream/rate_hz", label: "Frames that are streamed of each array", unit: "a second", min: 1, step: 1 },
];
const TRACK = "/drift/track";

/** The parameters of the server that a user may turn. */
export function makeThresholds(stream: Stream): HTMLDialogElement {
  const inputs = FIELDS.map(({ name, min, step }) => {
    const input = element("input", {
      type: "number",
      class: "field figure",
      min,
      step: "any",
      "data-step": step,
      "data-parameter": name,
      onchange: () => {
        if (input.checkValidity() && input.value !== "") stream.setParameter(name, Number(input.value));
      },
    });
    return input;
  });
  const track = element("input", {
    type: "checkbox",
    "data-parameter": TRACK,
    onchange: () => stream.setParameter(TRACK, track.checked),
  });
  stream.parameters.follow((parameters) => {
    FIELDS.forEach(({ name }, index) => {
      const value = parameters.get(name);
      const input = inputs[index]!;
      input.disabled = typeof value !== "number";
      if (typeof value === "number" && document.activeElement !== input) input.value = String(value);
    });
    track.disabled = typeof parameters.get(TRACK) !== "boolean";
    track.checked = parameters.get(TRACK) === true;
  });
  const zeros = element("p", { class: "dim lines", "data-role": "tare-log" });
  stream.parameters.follow((parameters) => {
    const log = parameters.get("/tare/log");
    setText(zeros, typeof log === "string" && log !== "" ? `Zeros that were taken:\n${log}` : "Nobody has tared.");
  });
  const rows = FIELDS.map(({ label, unit }, index) =>
    element(
      "label",
      { class: "parameter" },
      element("span", {}, label),
      inputs[index]!,
      element("span", { class: "dim" }, unit),
    ),
  );
  return element(
    "dialog",
    { class: "dialog", "aria-label": "Thresholds", "data-role": "thresholds" },
    element("h2", {}, "Thresholds"),
    ...rows,
    element("label", { class: "check" }, track, "Follow the zero of idle taxels as it drifts"),
    zeros,
    element("form", { method: "dialog" }, element("button", { class: "button" }, "Close")),
  );
}
