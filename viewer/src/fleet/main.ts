// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
import "../styles/tokens.css";
import "../styles/page.css";
import "../styles/controls.css";
import { FleetPage } from "./fleet_page";

new FleetPage().begin();
