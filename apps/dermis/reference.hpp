// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>
#include <vector>

#include "command_table.hpp"

namespace dermis::app {

struct ManualPage {
  std::string name;  ///< "dermis-run", or the file of a document.
  std::string text;  ///< roff or Markdown
};

/// A page of manual(1) a command, the whole of `dermis` first; in the order of --help.
[[nodiscard]] std::vector<ManualPage> manual_pages(const CommandTable& dermis);

/// The same as docs/command-line.md and docs/commands, a page for each group of commands.
[[nodiscard]] std::vector<ManualPage> command_documents(const CommandTable& dermis);

/// The purpose of an option, with the values that it takes, its default, and what it goes with.
[[nodiscard]] std::string whole_help(const OptionRow& option, bool is_argument);

/// The function of a shell that completes commands, options and files.
[[nodiscard]] std::string bash_completion(const CommandTable& dermis);
[[nodiscard]] std::string zsh_completion(const CommandTable& dermis);

/// Writes all of them where man, bash and zsh look for them below `prefix`, such as ~/.local or /usr.
[[nodiscard]] Status write_reference(const CommandTable& dermis, const std::string& prefix);

}  // namespace dermis::app
