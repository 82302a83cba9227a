// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "command_table.hpp"

#include <CLI/App.hpp>
#include <algorithm>
#include <set>
#include <sstream>

namespace dermis::app {
namespace {

/// Sorted: CLI11 keeps them by their addresses.
std::vector<std::string> names_of(const std::set<CLI::Option*>& options) {
  std::vector<std::string> names;
  for (const CLI::Option* option : options) names.push_back(option->get_name());
  std::sort(names.begin(), names.end());
  return names;
}

/// "simple" and "rubber" of "simple|rubber"; none of a value that is no list.
std::vector<std::string> choices_of(const std::string& value) {
  std::vector<std::string> choices;
  if (value.find('|') == std::string::npos) return choices;
  std::istringstream names(value);
  for (std::string name; std::getline(names, name, '|');) choices.push_back(name);
  return choices;
}

OptionRow option_row(const CLI::Option& option) {
  OptionRow row;
  for (const std::string& name : option.get_snames()) row.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) row.names.push_back("--" + name);
  if (option.get_positional()) row.names.push_back(option.get_name(true));
  row.values = option.get_items_expected_min();
  if (row.values > 0) row.value = option.get_type_name();
  row.choices = choices_of(row.value);
  row.default_value = option.get_default_str();
  row.help = option.get_description();
  row.group = option.get_group();
  row.needs = names_of(option.get_needs());
  row.excludes = names_of(option.get_excludes());
  row.is_repeated = option.get_expected_max() >= CLI::detail::expected_max_vector_size;
  row.is_required = option.get_required();
  return row;
}

CommandTable table_of(const CLI::App& app, const std::string& above) {
  CommandTable table;
  table.name = above + app.get_name();
  table.summary = app.get_description();
  table.group = app.get_group();
  for (const std::string& group : option_groups(app)) {
    const auto is_below = [&](const CLI::Option* option) { return option->get_group() == group; };
    for (const CLI::Option* option : app.get_options(is_below)) {
      (option->get_positional() ? table.arguments : table.options).push_back(option_row(*option));
    }
  }
  const auto is_shown = [](const CLI::App* command) { return !command->get_group().empty(); };
  for (const CLI::App* command : app.get_subcommands(is_shown)) {
    table.commands.push_back(table_of(*command, table.name + " "));
  }
  table.needs_command = app.get_require_subcommand_min() > 0;
  return table;
}

}  // namespace

std::vector<std::string> option_groups(const CLI::App& app) {
  std::vector<std::string> groups = app.get_groups();
  const auto rank = [](const std::string& group) {
    if (group == kReads) return 0;
    if (group == kWrites) return 1;
    return group == kOptions ? 3 : 2;
  };
  std::stable_sort(groups.begin(), groups.end(),
                   [&](const std::string& a, const std::string& b) { return rank(a) < rank(b); });
  return groups;
}

CommandTable command_table(const CLI::App& app) {
  return table_of(app, "");
}

}  // namespace dermis::app
