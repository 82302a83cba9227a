// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>

namespace dermis::app {

/// Notes that an input is not whole; what could be read of it is used. The process ends with these texts in its last
/// line and with a status other than 0. Thread-safe.
void note_loss(const std::string& text);

/// All that was noted, each text once, with semicolons between them; empty where nothing was.
[[nodiscard]] std::string losses();

}  // namespace dermis::app
