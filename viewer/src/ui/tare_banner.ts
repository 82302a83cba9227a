// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { button, element, setHidden, setText } from "../dom";
import type { Stream } from "../stream/stream";
import "./banners.css";

const UNDO_MS = 60_000; // docs/stream.md

/** Why no zero was taken, and what can be done about it. */
export function makeTareBanner(stream: Stream): HTMLElement {
  const words = element("p", { "data-role": "tare-refused" });
  const banner = element(
    "section",
    { class: "tare-banner", role: "alert", "aria-label": "Tare", "data-role": "tare-banner", hidden: true },
    words,
    button("Tare anyway", () => stream.setParameter("/tare/force", true), {
      "data-role": "tare-force",
      title: "What lies there reads 0 N from then on",
    }),
    button("Leave it", () => setHidden(banner, true)),
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
  const undo = button("Undo", () => stream.setParameter("/tare/undo", true), {
    "data-role": "undo-tare",
    title: "Back to the zero before the tare",
    hidden: true,
  });
  let timer = 0;
  stream.parameters.follow((parameters) => {
    const canUndo = parameters.get("/tare/undo") === true;
    if (canUndo === !undo.hidden) return;
    setHidden(undo, !canUndo);
    window.clearTimeout(timer);
    if (canUndo) timer = window.setTimeout(() => setHidden(undo, true), UNDO_MS);
  });
  return undo;
}
