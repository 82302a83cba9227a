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
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <type_traits>
#include <utility>
#include <vector>

#include "command_texts.hpp"
#include "dermis/bytes/files/safetensors.hpp"
#include "dermis/bytes/files/text.hpp"
#include "dermis/bytes/models/model_file.hpp"
#include "dermis/learn/recognition/classes_file.hpp"
#include "dermis/touch/frames/version.hpp"
#include "dermis/touch/pipeline/model.hpp"
#include "reference.hpp"
#include "status_line.hpp"
#include "usage_error.hpp"

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

/// Shows options group by group.
class GroupedFormatter : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override {
    std::string text = make_description(app) + make_usage(app, std::move(name)) + make_positionals(app);
    for (const std::string& group : option_groups(*app)) {
      const std::vector<const CLI::Option*> options = app->get_options(
          [&](const CLI::Option* option) { return option->get_group() == group && option->nonpositional(); });
      if (!options.empty()) text += make_group(group, false, options);
    }
    return text + make_subcommands(app, mode) + "\n" + make_footer(app);
  }
};

/// Texts below the options of all commands, and --help behind their own options.
void finish_help(CLI::App& app, const std::string& name) {
  for (CLI::App* command : app.get_subcommands(nullptr)) {
    const std::string whole = name + " " + command->get_name();
    command->footer(help_text(command_text(whole)));
    command->set_help_flag("-h,--help", "Print this help");
    finish_help(*command, whole);
  }
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

void Command::heading(const std::string& name) {
  heading_ = name;
}

CLI::Option* Command::below_heading(CLI::Option* option, const char* usual) const {
  return option->group(heading_.empty() ? usual : heading_);
}

template <typename Value>
Option Command::option(const std::string& name, Value& value, const std::string& help) {
  CLI::Option* const option = below_heading(app_.add_option(name, value, help), kOptions);
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
  return Option(below_heading(app_.add_flag(name, value, help), kOptions));
}

Option Command::flag(const std::string& name, std::string& value, const std::string& usual, const std::string& help) {
  return Option(below_heading(app_.add_flag(name + "{" + usual + "}", value, help), kOptions));
}

template <typename Value>
Option Command::input(const std::string& name, Value& value, const std::string& help) {
  places_->files.add_input(name, value);
  CLI::Option* const option = below_heading(app_.add_option(name, value, help), kReads);
  option->transform(stream_for_dash(kStandardInput));
  return Option(option);
}

template Option Command::input(const std::string&, std::string&, const std::string&);
template Option Command::input(const std::string&, std::vector<std::string>&, const std::string&);

Option Command::input_file(const std::string& name, std::string& path, const std::string& help) {
  places_->files.add_input(name, path);
  CLI::Option* const option = below_heading(app_.add_option(name, path, help), kReads);
  option->check(refuse_dash);
  return Option(option);
}

void Command::add_force() {
  if (places_->files.has_outputs()) return;
  const std::string help = "Replace a recording, model, description or dataset that exists";
  below_heading(app_.add_flag("--force", places_->is_forced, help), kWrites);
}

Option Command::output(const std::string& name, std::string& path, const std::string& help) {
  add_force();
  places_->files.add_output(name, path);
  CLI::Option* const option = below_heading(app_.add_option(name, path, help), kWrites);
  option->transform(stream_for_dash(kStandardOutput));
  return Option(option);
}

void Command::outputs_beside(const std::string& name, std::function<std::vector<std::string>()> paths) {
  places_->files.add_outputs(name, std::move(paths));
}

Option Command::output_model(const std::string& name, std::string& path, const std::string& help) {
  add_force();
  places_->files.add_model_output(name, path);
  CLI::Option* const option = below_heading(app_.add_option(name, path, help), kWrites);
  option->check(refuse_dash);
  return Option(option);
}

Option Command::output_folder(const std::string& name, std::string& folder, const std::vector<std::string>& files,
                              const std::string& help) {
  add_force();
  places_->files.add_output_folder(name, folder, files);
  CLI::Option* const option = below_heading(app_.add_option(name, folder, help), kWrites);
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
  app.formatter(std::make_shared<GroupedFormatter>());
  Action chosen;
  add_reference(app, chosen);
  for (const CommandEntry& entry : commands) {
    Command command(*app.add_subcommand(entry.name, entry.summary)->group(entry.group), chosen);
    entry.add(command);
  }
  finish_help(app, app.get_name());
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
