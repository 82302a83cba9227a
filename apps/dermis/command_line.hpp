// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "dermis/touch/frames/result.hpp"
#include "file_places.hpp"

// All of CLI11 that the commands see: its headers cost seconds in every file that includes them.
namespace CLI {  // NOLINT(readability-identifier-naming): its name
class App;
class Option;
}  // namespace CLI

namespace dermis::app {

/// The work of the chosen command; the exit status of the process where it does not fail.
using Action = std::function<Result<int>()>;

/// An option of a command, to say more of it.
class Option {
 public:
  explicit Option(CLI::Option* option) : option_(option) {}

  Option required() const;
  Option shows_default() const;       ///< The help names the value that it has without the option.
  Option takes(int values) const;     ///< So many values, not one.
  Option takes_list(int most) const;  ///< One to so many values, with commas between them.
  /// The names that it knows, for the help and for completion; the action says what is wrong with another.
  Option one_of(const std::vector<std::string>& names) const;
  Option excludes(Option other) const;
  Option needs(Option other) const;

 private:
  CLI::Option* option_;
};

/// A command whose options are being declared. The variables for its options must live as long as the action.
class Command {
 public:
  Command(CLI::App& app, Action& chosen) : app_(app), chosen_(chosen) {}

  /// The options that follow stand below it in the help, instead of below what they do with files.
  void heading(const std::string& name);

  /// `name`: "--in", or "in" for an argument that is known by its place. For a Value of std::string, double,
  /// std::uint16_t, std::uint64_t, std::vector of double or std::string, or std::optional of double or std::uint64_t.
  template <typename Value>
  Option option(const std::string& name, Value& value, const std::string& help);
  Option flag(const std::string& name, bool& value, const std::string& help);
  /// A flag that may have a text, as --ask=r; without one it has `usual`.
  Option flag(const std::string& name, std::string& value, const std::string& usual, const std::string& help);

  /// An option that names a file or a source to read; "-" is the standard input. `Value`: std::string, or a std::vector
  /// of them.
  template <typename Value>
  Option input(const std::string& name, Value& value, const std::string& help);
  /// The same for files that no stream can bring: a model, classes, and all that are read more than once.
  Option input_file(const std::string& name, std::string& path, const std::string& help);
  /// An option that names a file to write; "-" is the standard output. The action is not called where that would
  /// overwrite what is not to be.
  Option output(const std::string& name, std::string& path, const std::string& help);
  /// Files that `name` writes beside its own.
  void outputs_beside(const std::string& name, std::function<std::vector<std::string>()> paths);
  /// The same as output() for a model or classes, and not "-". The action keeps earlier ones by keep_earlier_model(),
  /// so they are no reason.
  Option output_model(const std::string& name, std::string& path, const std::string& help);
  /// The same for these files in a folder, and not "-".
  Option output_folder(const std::string& name, std::string& folder, const std::vector<std::string>& files,
                       const std::string& help);

  /// A command of this command. The user must name one, unless this command has got an action before. The options that
  /// this command requires are those of that action.
  Command subcommand(const std::string& name, const std::string& summary);

  void action(std::function<Status()> action);
  /// For a command whose exit status says more.
  void action_with_exit_status(Action action);

 private:
  void add_force();
  CLI::Option* below_heading(CLI::Option* option, const char* usual) const;

  struct Places {
    FilePlaces files;
    bool is_forced = false;
    std::vector<CLI::Option*> required{};
  };

  CLI::App& app_;
  Action& chosen_;
  bool has_action_ = false;
  std::string heading_;
  std::shared_ptr<Places> places_ = std::make_shared<Places>();
};

struct CommandEntry {
  const char* name;
  const char* summary;
  const char* group;              ///< The heading above it in the help.
  void (*add)(Command& command);  ///< Declares its options and its action.
};

/// The action of the command line; empty where --help or --version has been printed, and nothing is left to do.
[[nodiscard]] Result<Action> parse_command_line(int argc, char** argv, std::span<const CommandEntry> commands);

}  // namespace dermis::app
