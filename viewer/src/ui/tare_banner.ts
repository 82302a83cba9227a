// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { element, setHidden, setText } from "../dom";
import type { Stream } from "../stream/stream";

const UNDO_MS = 60_000; // docs/stream.md

/** Why no zero was taken, and what can be done about it. */
export function makeTareBanner(stream: Stream): HTMLElement {
  const words = element("p", { "data-role": "tare-refused" });
  const banner = element(
    "section",
    { class: "tare-banner", role: "alert", "aria-label": "Tare", "data-role": "tare-banner", hidden: true },
    words,
    element(
      "button",
      {
        class: "button",
        "data-role": "tare-force",
        title: "What lies there reads 0 N from then on",
        onclick: () => stream.setParameter("/tare/force", true),
      },
      "Tare anyway",
    ),
    element("button", { class: "button", onclick: () => setHidden(banner, true) }, "Leave it"),
  );
  let last: unknown = "";
  stream.parameters.follow((parameters) => {
    const refusal = parameters.get("/tare/refused");
    if (refusal === last) return;
    last = refusal;
    const isRefused = typeof refusal === "string" && refusal !== "";
    if (isRefused) setText(words, `Not tared. ${refusal}`);
    setHidden(banner, !isRefused);
  });
  return banner;
}

/** Takes the last tare back, as long as that is possible. */
export function makeUndoTare(stream: Stream): HTMLElement {
  const button = element(
    "button",
    {
      class: "button",
      "data-role": "undo-tare",
      title: "Back to the zero before the tare",
      hidden: true,
      onclick: () => stream.setParameter("/tare/undo", true),
    },
    "Undo",
  );
  let timer = 0;
  stream.parameters.follow((parameters) => {
    const canUndo = parameters.get("/tare/undo") === true;
    if (canUndo === !button.hidden) return;
    setHidden(button, !canUndo);
    window.clearTimeout(timer);
    if (canUndo) timer = window.setTimeout(() => setHidden(button, true), UNDO_MS);
  });
  return button;
}
