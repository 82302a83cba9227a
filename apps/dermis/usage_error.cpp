// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "usage_error.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <iterator>
#include <set>
#include <vector>

#include "dermis/bytes/files/force_text.hpp"
#include "dermis/bytes/files/text.hpp"
#include "dermis/touch/frames/nearest_name.hpp"

namespace dermis::app {
namespace {

std::string first_line(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

std::set<std::string> options_of(const CLI::App& command) {
  std::set<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.insert("--" + name);
  }
  return names;
}

std::set<std::string> commands_of(const CLI::App& command) {
  std::set<std::string> names;
  for (const CLI::App* each : command.get_subcommands(nullptr)) names.insert(each->get_name());
  return names;
}

/// The last command that was named.
const CLI::App& chosen_command(const CLI::App& app) {
  const std::vector<CLI::App*> named = app.get_subcommands();
  return named.empty() ? app : chosen_command(*named.back());
}

/// The commands at and below `command` that do so, by their whole names in quotes.
template <typename Does>
std::vector<std::string> commands_that(const Does& does, const CLI::App& command, const std::string& name) {
  std::vector<std::string> found;
  if (does(command)) found.push_back(bytes::files::in_quotes(name));
  for (const CLI::App* each : command.get_subcommands(nullptr)) {
    const std::vector<std::string> below = commands_that(does, *each, name + " " + each->get_name());
    found.insert(found.end(), below.begin(), below.end());
  }
  return found;
}

/// The mend where somebody wrote a force as two arguments, "200 g"; else empty.
std::string force_in_two(const std::string& argument, std::span<char* const> arguments) {
  const auto found = std::find(arguments.begin() + 1, arguments.end(), argument);
  if (found == arguments.end()) return "";
  const std::string number = *std::prev(found);
  double value = 0.0;
  const bool is_number = bytes::files::parse_number(number, value) && !bytes::files::parse_number(argument, value);
  if (!is_number || !bytes::files::parse_force(number + argument)) return "";
  return fmt::format("; write '{0} {1}' in quotes, or {0}{1}", number, argument);
}

}  // namespace

std::string unknown(const std::string& argument, const CLI::App& command, const CLI::App& app) {
  const bool is_option = argument.starts_with('-');
  const std::set<std::string> known = is_option ? options_of(command) : commands_of(command);
  if (known.empty()) return fmt::format("'{}' is one argument too many", argument);
  const std::string name = argument.substr(0, argument.find('='));
  const std::string nearest = nearest_name(name, known);
  std::string what = fmt::format("unknown {} '{}'", is_option ? "option" : "command", name);
  const auto has_name = [&](const CLI::App& each) { return each.get_name() == name; };
  const auto takes_it = [&](const CLI::App& each) { return each.get_option_no_throw(name) != nullptr; };
  const std::vector<std::string> named =
      is_option ? std::vector<std::string>() : commands_that(has_name, app, app.get_name());
  if (!named.empty()) return fmt::format("{}; there is {}", what, fmt::join(named, " and "));
  if (!nearest.empty()) return fmt::format("{}; did you mean '{}'?", what, nearest);
  constexpr std::size_t kFew = 2;
  const std::vector<std::string> takers =
      is_option ? commands_that(takes_it, app, app.get_name()) : std::vector<std::string>();
  if (takers.empty() || takers.size() > kFew) return what;
  return fmt::format("{}; it is one of {}", what, fmt::join(takers, " and "));
}

std::string message_of(const CLI::ParseError& error, const CLI::App& app, std::span<char* const> arguments) {
  const std::vector<std::string> nobody_took = app.remaining(true);
  if (nobody_took.empty()) return first_line(error.what());
  const std::string& first = nobody_took.front();
  return unknown(first, chosen_command(app), app) + force_in_two(first, arguments);
}

}  // namespace dermis::app
