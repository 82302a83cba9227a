// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { button, element } from "../dom";
import type { BoardLink } from "./board_link";

/** Shows what a link brings before it is used. */
export function makeLinkPanel({ layout, baud }: BoardLink, use: () => void): HTMLElement {
  const end = (act: () => void): void => {
    act();
    section.remove();
  };
  const section = element(
    "section",
    { class: "panel", "aria-label": "The layout of the link", "data-role": "link-layout" },
    element("h2", {}, "The link brings the layout of a board"),
    element(
      "p",
      {},
      `It says how bytes become readings${baud === undefined ? "" : `, at ${baud} baud`}, and with start or request what is sent to the board.`,
    ),
    element("pre", { class: "first-bytes link-layout", tabindex: 0, "aria-label": "The layout" }, layout),
    element(
      "div",
      { class: "setup-row" },
      button("Use it", () => end(use), { class: "primary", "data-role": "use-link" }),
      button("Leave it", () => end(() => undefined), { "data-role": "leave-link" }),
    ),
  );
  return section;
}
