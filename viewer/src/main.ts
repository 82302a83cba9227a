// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import { errorText } from "./format";
import "./styles/tokens.css";
import "./styles/page.css";
import "./styles/controls.css";
import { App } from "./app";
import { ServerEndpoint } from "./stream/endpoint";

try {
  new App(new ServerEndpoint(new URL(window.location.href))).begin();
} catch (error) {
  // A blank page says nothing: a browser without WebGL 2, for one, gets this line.
  const line = document.createElement("p");
  line.setAttribute("role", "alert");
  line.textContent = errorText(error);
  document.body.replaceChildren(line);
  throw error;
}
