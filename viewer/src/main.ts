// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import "./styles/page.css";
import "./styles/views.css";
import { App } from "./app";

new App().begin();
