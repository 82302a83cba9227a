// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <span>
#include <string>
#include <vector>

#include "dermis/touch/frames/result.hpp"

namespace dermis::app {

/// The command line of the process. Its secrets are 'x' for ps from now on, and a line tells that they were there. The
/// password of a hub is no longer in its address but in the environment. Call it before there are threads. Fails where
/// hubs have different passwords.
[[nodiscard]] Result<std::vector<std::string>> take_arguments(std::span<char* const> arguments);

}  // namespace dermis::app
