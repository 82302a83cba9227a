// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>
#include <vector>

#include "command_table.hpp"

namespace dermis::app {

/// A page of manual(1) a command, the whole of `dermis` first; in the order of --help.
struct ManualPage {
  std::string name;  ///< "dermis-run"
  std::string text;  ///< roff
};
[[nodiscard]] std::vector<ManualPage> manual_pages(const CommandTable& dermis);

/// The function of a shell that completes commands, options and files.
[[nodiscard]] std::string bash_completion(const CommandTable& dermis);
[[nodiscard]] std::string zsh_completion(const CommandTable& dermis);

/// Writes all of them where man, bash and zsh look for them below `prefix`, such as ~/.local or /usr.
[[nodiscard]] Status write_reference(const CommandTable& dermis, const std::string& prefix);

}  // namespace dermis::app
