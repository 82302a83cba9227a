// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { element, setText } from "../dom";
import type { Stream } from "../stream/stream";
import "./token_form.css";

/** Asks for the token where the server wants another. */
export function makeTokenForm(stream: Stream): HTMLElement {
  const field = element("input", {
    type: "password",
    class: "field",
    id: "token",
    autocomplete: "off",
    required: true,
  });
  const words = element("p");
  const form = element(
    "form",
    { class: "panel token-form", "data-role": "token-form", "aria-label": "Token", hidden: true },
    element("h2", {}, "The server asks for its token"),
    words,
    element("label", { for: "token" }, "Token"),
    field,
    element("button", { class: "button primary", type: "submit" }, "Connect"),
  );
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    stream.connectWith(field.value);
  });
  stream.connection.follow(({ kind }) => {
    if (kind === "live") rememberInAddress(stream.token);
    if (kind === "connecting") return;
    form.hidden = kind !== "wrong token";
    if (form.hidden) return;
    setText(
      words,
      stream.token === ""
        ? "It is the one that dermis serve was started with: --token."
        : "It is not the one that this page has.",
    );
    field.value = "";
    field.focus();
  });
  return form;
}

/** So that the page can be loaded again. */
function rememberInAddress(token: string): void {
  const address = new URL(window.location.href);
  if (token === "" || address.searchParams.get("token") === token) return;
  address.searchParams.set("token", token);
  window.history.replaceState(null, "", address);
}
