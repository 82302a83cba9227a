// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { button, element, setHidden, setText } from "../dom";
import type { Stream } from "../stream/stream";
import "./banners.css";

const UNDO_MS = 60_000; // docs/stream.md
const REFUSED_MS = 60_000;

/** Why no zero was taken, and what can be done about it; for a minute. */
export function makeTareBanner(stream: Stream): HTMLElement {
  const words = element("p", { "data-role": "tare-refused" });
  const leave = (): void => setHidden(banner, true);
  const banner = element(
    "section",
    { class: "tare-banner message", role: "alert", "aria-label": "Tare", "data-role": "tare-banner", hidden: true },
    words,
    button("Tare anyway", () => stream.setParameter("/tare/force", true), {
      "data-role": "tare-force",
      title: "What lies there reads 0 N from then on",
    }),
    button("Leave it", leave, { "data-role": "tare-leave" }),
  );
  let last: unknown = "";
  let timer = 0;
  stream.parameters.follow((parameters) => {
    const refusal = parameters.get("/tare/refused");
    if (refusal === last) return;
    last = refusal;
    const isRefused = typeof refusal === "string" && refusal !== "";
    if (isRefused) setText(words, `Not tared. ${refusal}`);
    setHidden(banner, !isRefused);
    window.clearTimeout(timer);
    if (isRefused) timer = window.setTimeout(leave, REFUSED_MS);
  });
  return banner;
}

/** Whether a line of the server's log says again that a tare was refused. */
export function isOfRefusedTare(line: string): boolean {
  return line.includes(" was not tared, as ");
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
