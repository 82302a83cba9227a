// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "command_line.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <system_error>
#include <type_traits>
#include <utility>
#include <vector>

#include "dermis/bytes/files/force_text.hpp"
#include "dermis/bytes/files/safetensors.hpp"
#include "dermis/bytes/files/text.hpp"
#include "dermis/bytes/models/model_file.hpp"
#include "dermis/learn/recognition/classes_file.hpp"
#include "dermis/touch/frames/nearest_name.hpp"
#include "dermis/touch/frames/version.hpp"
#include "dermis/touch/pipeline/model.hpp"
#include "reference.hpp"
#include "status_line.hpp"

namespace dermis::app {
namespace {

constexpr const char* kMoreHelp =
    "dermis help COMMAND: its options; guides: docs/ of the source, /usr/share/doc/dermis of a package";

/// CLI11 would wrap a negative count round, and names neither range nor mend.
template <typename Number>
std::string check_count(const std::string& text) {
  if (text.starts_with('-')) return "must not be negative";
  Number number = 0;
  const char* const text_end = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), text_end, number);
  if (error == std::errc() && end == text_end) return "";
  if (error == std::errc::result_out_of_range) {
    return fmt::format("must be 0 to {}", std::numeric_limits<Number>::max());
  }
  return fmt::format("'{}' is no whole number; write one such as 200", text);
}

std::string check_number(const std::string& text) {
  double number = 0.0;
  return bytes::files::parse_number(text, number) ? "" : fmt::format("'{}' is no number", text);
}

template <typename Value>
void check_text(CLI::Option& option, const Value& /*value*/) {
  if constexpr (std::is_unsigned_v<Value>) option.check(check_count<Value>);
  if constexpr (std::is_floating_point_v<Value>) option.check(check_number);
}

template <typename Value>
void check_text(CLI::Option& option, const std::optional<Value>& /*value*/) {
  check_text(option, Value());
}

template <typename Value>
void check_text(CLI::Option& option, const std::vector<Value>& /*value*/) {
  check_text(option, Value());
}

/// The meaning of "-".
std::function<std::string(std::string)> stream_for_dash(const std::string& stream) {
  return [stream](const std::string& name) { return name == "-" ? stream : name; };
}

std::string refuse_dash(const std::string& name) {
  return name == "-" ? "'-' is no file; name one" : "";
}

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

/// Names the problem of an unknown argument of a command of `app`. Adds the name that may have been meant, the
/// command below another that has it, or the few commands that take such an option.
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

/// The mend where somebody wrote a force as two arguments, "200 g"; else empty.
std::string force_in_two(const std::string& argument, std::span<char* const> arguments) {
  const auto found = std::find(arguments.begin() + 1, arguments.end(), argument);
  if (found == arguments.end()) return "";
  const std::string number = *std::prev(found);
  const bool is_number = check_number(number).empty() && !check_number(argument).empty();
  if (!is_number || !bytes::files::parse_force(number + argument)) return "";
  return fmt::format("; write '{0} {1}' in quotes, or {0}{1}", number, argument);
}

std::string message_of(const CLI::ParseError& error, const CLI::App& app, std::span<char* const> arguments) {
  const std::vector<std::string> nobody_took = app.remaining(true);
  if (nobody_took.empty()) return first_line(error.what());
  const std::string& first = nobody_took.front();
  return unknown(first, chosen_command(app), app) + force_in_two(first, arguments);
}

/// "simulate, calibrate, ... or serve"
std::string names_of(std::span<const CommandEntry> commands) {
  std::string names = commands.front().name;
  for (const CommandEntry& command : commands.subspan(1)) {
    names += (&command == &commands.back() ? " or " : ", ") + std::string(command.name);
  }
  return names;
}

/// Says which of the command's files, of those that dermis writes, were written before such files had checksums.
void tell_missing_checksums(const CLI::App& command) {
  static constexpr std::array<std::pair<const char*, bytes::files::FileFormat>, 2> kFiles{
      {{"--model", bytes::models::kModelFormat}, {"--classes", learn::recognition::kClassesFormat}}};
  for (const auto& [name, format] : kFiles) {
    const CLI::Option* const option = command.get_option_no_throw(name);
    if (option == nullptr || option->count() == 0) continue;
    if (const auto note = bytes::files::checksum_note(option->as<std::string>(), format)) print_notice(*note);
  }
}

/// The --help of the command with these names, "circuit" "forward".
Result<std::string> help_of(const CLI::App& app, const std::vector<std::string>& names) {
  const CLI::App* command = &app;
  std::string full_name = app.get_name();
  for (const std::string& name : names) {
    const auto commands = command->get_subcommands([&](const CLI::App* each) { return each->get_name() == name; });
    if (commands.empty()) return bad_input(unknown(name, *command, app) + " (see dermis --help)");
    command = commands.front();
    full_name += " " + name;
  }
  return command->get_formatter()->make_help(command, full_name, CLI::AppFormatMode::Normal);
}

/// For those who type it in place of --help.
void add_help(CLI::App& app, Action& chosen) {
  CLI::App& command = *app.add_subcommand("help", "Show what a command takes");
  command.group("");
  auto names = std::make_shared<std::vector<std::string>>();
  command.add_option("command", *names, "Such as run, or circuit forward");
  command.callback([&app, &chosen, names] {
    chosen = [text = help_of(app, *names)]() -> Result<int> {
      if (!text) return text.error();
      fmt::print("{}", *text);
      return 0;
    };
  });
}

/// For those who make packages, so --help does not name it.
void add_reference(CLI::App& app, Action& chosen) {
  CLI::App& command = *app.add_subcommand("reference", "Write the manual pages and the completion of bash and zsh");
  command.group("");
  auto prefix = std::make_shared<std::string>();
  command.add_option("prefix", *prefix, "Folder whose share/ is written to, such as ~/.local")->required();
  command.callback([&app, &chosen, prefix] {
    chosen = [table = command_table(app), prefix]() -> Result<int> {
      const Status written = write_reference(table, *prefix);
      if (!written) return written.error();
      return 0;
    };
  });
}

}  // namespace

Option Option::required() const {
  option_->required();
  return *this;
}

Option Option::shows_default() const {
  option_->capture_default_str();
  return *this;
}

Option Option::takes(int values) const {
  option_->expected(values);
  return *this;
}

Option Option::takes_list(int most) const {
  option_->delimiter(',')->expected(1, most);
  return *this;
}

Option Option::one_of(const std::vector<std::string>& names) const {
  option_->type_name(fmt::format("{}", fmt::join(names, "|")));
  return *this;
}

Option Option::excludes(Option other) const {
  option_->excludes(other.option_);
  return *this;
}

Option Option::needs(Option other) const {
  option_->needs(other.option_);
  return *this;
}

template <typename Value>
Option Command::option(const std::string& name, Value& value, const std::string& help) {
  CLI::Option* const option = app_.add_option(name, value, help);
  check_text(*option, value);
  return Option(option);
}

template Option Command::option(const std::string&, std::string&, const std::string&);
template Option Command::option(const std::string&, double&, const std::string&);
template Option Command::option(const std::string&, std::uint16_t&, const std::string&);
template Option Command::option(const std::string&, std::uint64_t&, const std::string&);
template Option Command::option(const std::string&, std::vector<double>&, const std::string&);
template Option Command::option(const std::string&, std::vector<std::string>&, const std::string&);
template Option Command::option(const std::string&, std::optional<double>&, const std::string&);
template Option Command::option(const std::string&, std::optional<std::uint64_t>&, const std::string&);

Option Command::flag(const std::string& name, bool& value, const std::string& help) {
  return Option(app_.add_flag(name, value, help));
}

Option Command::flag(const std::string& name, std::string& value, const std::string& usual, const std::string& help) {
  return Option(app_.add_flag(name + "{" + usual + "}", value, help));
}

template <typename Value>
Option Command::input(const std::string& name, Value& value, const std::string& help) {
  places_->files.add_input(name, value);
  CLI::Option* const option = app_.add_option(name, value, help);
  option->transform(stream_for_dash(kStandardInput));
  return Option(option);
}

template Option Command::input(const std::string&, std::string&, const std::string&);
template Option Command::input(const std::string&, std::vector<std::string>&, const std::string&);

Option Command::input_file(const std::string& name, std::string& path, const std::string& help) {
  places_->files.add_input(name, path);
  CLI::Option* const option = app_.add_option(name, path, help);
  option->check(refuse_dash);
  return Option(option);
}

void Command::add_force() {
  if (places_->files.has_outputs()) return;
  flag("--force", places_->is_forced, "Replace a recording, model, description or dataset that exists");
}

Option Command::output(const std::string& name, std::string& path, const std::string& help) {
  add_force();
  places_->files.add_output(name, path);
  CLI::Option* const option = app_.add_option(name, path, help);
  option->transform(stream_for_dash(kStandardOutput));
  return Option(option);
}

void Command::outputs_beside(const std::string& name, std::function<std::vector<std::string>()> paths) {
  places_->files.add_outputs(name, std::move(paths));
}

Option Command::output_model(const std::string& name, std::string& path, const std::string& help) {
  add_force();
  places_->files.add_model_output(name, path);
  CLI::Option* const option = app_.add_option(name, path, help);
  option->check(refuse_dash);
  return Option(option);
}

Option Command::output_folder(const std::string& name, std::string& folder, const std::vector<std::string>& files,
                              const std::string& help) {
  add_force();
  places_->files.add_output_folder(name, folder, files);
  CLI::Option* const option = app_.add_option(name, folder, help);
  option->check(refuse_dash);
  return Option(option);
}

Command Command::subcommand(const std::string& name, const std::string& summary) {
  app_.require_subcommand(has_action_ ? 0 : 1, 1);
  for (CLI::Option* option : app_.get_options()) {
    if (option->get_required()) places_->required.push_back(option->required(false));
  }
  return {*app_.add_subcommand(name, summary)->group("Subcommands"), chosen_};
}

void Command::action(std::function<Status()> action) {
  action_with_exit_status([action = std::move(action)]() -> Result<int> {
    const Status status = action();
    if (!status) return status.error();
    return 0;
  });
}

void Command::action_with_exit_status(Action action) {
  has_action_ = true;
  app_.callback([&chosen = chosen_, &command = app_, places = places_, action = std::move(action)] {
    if (!command.get_subcommands().empty()) return;
    for (const CLI::Option* option : places->required) {
      if (option->empty()) throw CLI::RequiredError(option->get_name());
    }
    tell_missing_checksums(command);
    chosen = [places, action]() -> Result<int> {
      if (Status kept = places->files.check(places->is_forced); !kept) return kept.error();
      return action();
    };
  });
}

Result<Action> parse_command_line(int argc, char** argv, std::span<const CommandEntry> commands) {
  CLI::App app{"dermis: calibrated force (newtons) from resistive tactile arrays", "dermis"};
  app.set_version_flag("--version", DERMIS_VERSION);
  app.require_subcommand(0, 1);
  Action chosen;
  add_reference(app, chosen);
  for (const CommandEntry& entry : commands) {
    Command command(*app.add_subcommand(entry.name, entry.summary)->group(entry.group), chosen);
    entry.add(command);
  }
  add_help(app, chosen);
  app.footer(kMoreHelp);  // after the commands, which would inherit it
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0)
      return bad_input(message_of(error, app, {argv, static_cast<std::size_t>(argc)}) + " (see dermis --help)");
    app.exit(error);  // prints what was asked for
    return Action();
  }
  if (!chosen) return bad_input(fmt::format("name a command: {} (see dermis --help)", names_of(commands)));
  return chosen;
}

}  // namespace dermis::app
