// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>
#include <vector>

#include "command_line.hpp"

namespace dermis::app {

inline constexpr const char* kReads = "Reads";
inline constexpr const char* kWrites = "Writes";
inline constexpr const char* kOptions = "Options";

/// An option or an argument as --help shows it.
struct OptionRow {
  std::vector<std::string> names;    ///< "-h" and "--help"; of an argument its one name, "in".
  std::string value;                 ///< Kind of its value, "TEXT" or "simple|rubber"; empty for a flag.
  std::vector<std::string> choices;  ///< The names that it knows, where there is a list of them.
  std::string default_value;         ///< Empty where none is shown.
  std::string help;
  std::string group;                  ///< The heading above it.
  std::vector<std::string> needs;     ///< Options that must be given, too.
  std::vector<std::string> excludes;  ///< Options that must not be given, too.
  int values = 1;                     ///< How many it takes; 0 for a flag.
  bool is_repeated = false;           ///< Takes any number of values.
  bool is_required = false;
};

/// A command with what it takes, as --help shows it.
struct CommandTable {
  std::string name;  ///< Name with those of the commands above it: "dermis circuit invert".
  std::string summary;
  std::string group;               ///< The heading above it in the help.
  std::vector<OptionRow> options;  ///< Group by group.
  std::vector<OptionRow> arguments;
  std::vector<CommandTable> commands;
  bool needs_command = false;  ///< One of these must be named.
};

/// Headings of its options in the order of --help: those of files first, "Options" last.
[[nodiscard]] std::vector<std::string> option_groups(const CLI::App& app);

/// The --help of a command and of all that are below it.
[[nodiscard]] CommandTable command_table(const CLI::App& app);

}  // namespace dermis::app
