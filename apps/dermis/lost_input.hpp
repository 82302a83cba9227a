// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>
#include <vector>

namespace dermis::app {

/// Notes that an input is not whole; what could be read of it is used. The process ends with these lines and with a
/// status other than 0. Thread-safe.
void note_loss(const std::string& line);

/// All that was noted, each line once.
[[nodiscard]] std::vector<std::string> losses();

}  // namespace dermis::app
