// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { element } from "../dom";

const KEYS: readonly (readonly [string, string])[] = [
  ["1 \u2026 6", "the views"],
  ["[  ]", "previous, next array"],
  ["Space", "stop the picture, go on"],
  ["T", "tare: what the array shows now is zero"],
  ["R", "begin or end a recording"],
  ["S", "recordings, the last minute, pictures"],
  ["I", "interpolate between taxels"],
  ["C", "show contacts"],
  ["M", "mark this moment"],
  ["Arrows", "on the maps: move the cursor; on the suit: turn it"],
  ["Enter", "on the maps: pin the taxel, or set a corner of the region"],
  ["+  \u2212  Home", "on the suit: nearer, farther, all arrays"],
  ["N  B  Enter", "calibration: skip to the next press, back to the last one, save"],
  ["K", "recording: play, pause"],
  ["J  L", "recording: a second back, forward"],
  ["D", "light or dark"],
  ["?", "this help"],
];

export function makeHelp(): HTMLDialogElement {
  const rows = KEYS.map(([key, does]) =>
    element("tr", {}, element("th", { scope: "row" }, element("kbd", {}, key)), element("td", {}, does)),
  );
  const dialog = element(
    "dialog",
    { class: "dialog", "aria-label": "Keys", "data-role": "help" },
    element("h2", {}, "Keys"),
    element("table", { class: "table" }, element("tbody", {}, ...rows)),
    element("form", { method: "dialog" }, element("button", { class: "button" }, "Close")),
  );
  return dialog;
}
