// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>
#include <string_view>

namespace dermis::app {

/// The words of --help, manual pages and docs/commands on a command, beside its options.
struct CommandText {
  std::string_view command;     ///< "dermis circuit invert"
  std::string_view about;       ///< Sentences; docs/NAME.md in them is a page of the documentation.
  std::string_view examples{};  ///< A command a line.
};

/// Empty where there is none.
[[nodiscard]] CommandText command_text(std::string_view command);

/// "about" in lines of at most 100 characters, and the examples; empty where there is nothing to say.
[[nodiscard]] std::string help_text(const CommandText& text);

/// Sections of docs/command-line.md on all commands, in Markdown.
[[nodiscard]] std::string_view general_text();

}  // namespace dermis::app
