// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <span>
#include <string>

#include "command_line.hpp"

namespace CLI {  // NOLINT(readability-identifier-naming): its name
class ParseError;
}  // namespace CLI

namespace dermis::app {

/// Names the problem of an unknown argument of a command of `app`. Adds the name that may have been meant, the
/// command below another that has it, or the few commands that take such an option.
[[nodiscard]] std::string unknown(const std::string& argument, const CLI::App& command, const CLI::App& app);

/// One line on what is wrong with the arguments.
[[nodiscard]] std::string message_of(const CLI::ParseError& error, const CLI::App& app,
                                     std::span<char* const> arguments);

}  // namespace dermis::app
