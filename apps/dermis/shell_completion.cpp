// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <string_view>

#include "reference.hpp"

namespace dermis::app {
namespace {

constexpr const char* kLicence = "# SPDX-License-Identifier: Apache-2.0\n";
constexpr const char* kText = "TEXT";  // of all values, the only ones that may name a file

std::string joined(const std::vector<std::string>& words, const char* between) {
  return fmt::format("{}", fmt::join(words, between));
}

std::string last_word(const std::string& name) {
  return name.substr(name.rfind(' ') + 1);
}

using Visit = std::function<void(const CommandTable&)>;

/// The command and all below it.
void for_each_command(const CommandTable& command, const Visit& visit) {
  visit(command);
  for (const CommandTable& part : command.commands) for_each_command(part, visit);
}

/// Names of the options whose values may, or may not, be files.
std::vector<std::string> valued_options(const CommandTable& command, bool files) {
  std::vector<std::string> names;
  for (const OptionRow& option : command.options) {
    if (option.values == 0 || !option.choices.empty() || (option.value == kText) != files) continue;
    names.insert(names.end(), option.names.begin(), option.names.end());
  }
  return names;
}

/// The words that may follow a command: the names of its commands and its options.
std::vector<std::string> words_after(const CommandTable& command) {
  std::vector<std::string> words;
  for (const CommandTable& part : command.commands) words.push_back(last_word(part.name));
  for (const OptionRow& option : command.options) words.push_back(option.names.back());
  return words;
}

std::string bash_case(const CommandTable& command) {
  return fmt::format("    '{}')\n      words='{}'\n      files=' {} '\n      others=' {} '\n      arguments={} ;;\n",
                     command.name, joined(words_after(command), " "), joined(valued_options(command, true), " "),
                     joined(valued_options(command, false), " "), command.arguments.size());
}

/// The offered words where the value of an option is one of some names.
std::string bash_choices(const CommandTable& command) {
  std::string cases;
  for (const OptionRow& option : command.options) {
    if (option.choices.empty()) continue;
    cases += fmt::format("    '{} {}') words='{}' arguments=0 ;;\n", command.name, option.names.back(),
                         joined(option.choices, " "));
  }
  return cases;
}

/// Text between single quotes of a shell.
std::string in_quotes(std::string_view text) {
  std::string inside;
  for (const char c : text) inside += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return "'" + inside + "'";
}

/// Quotes a text in brackets or before a colon for zsh.
std::string zsh_text(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '[' || c == ']' || c == ':' || c == '\\') escaped += '\\';
    escaped += c;
  }
  return escaped;
}

std::string zsh_option(const OptionRow& option) {
  std::string rest = option.values == 0 ? "" : "=";
  rest += "[" + zsh_text(option.help) + "]";
  for (int value = 0; value < option.values; ++value) {
    const std::string names = fmt::format(":name:({})", joined(option.choices, " "));
    rest += option.value == kText ? ":file or name:_files" : option.choices.empty() ? ":number: " : names;
  }
  std::string specification;
  for (const std::string& name : option.names) {
    specification += " \\\n    " + in_quotes(fmt::format("{}{}{}", option.is_repeated ? "*" : "", name, rest));
  }
  return specification;
}

std::string zsh_function_name(const CommandTable& command) {
  std::string name = "_" + command.name;
  std::replace(name.begin(), name.end(), ' ', '-');
  return name;
}

std::string zsh_function(const CommandTable& command) {
  const std::string name = zsh_function_name(command);
  std::string text = name + "() {\n";
  if (!command.commands.empty()) text += "  local curcontext=$curcontext state\n";
  text += "  _arguments -C";
  for (const OptionRow& option : command.options) text += zsh_option(option);
  for (const OptionRow& argument : command.arguments) {
    text += " \\\n    " + in_quotes(":" + zsh_text(argument.help) + ":_files");
  }
  if (command.commands.empty()) return text + "\n}\n\n";
  text += " \\\n    '1: :->command' \\\n    '*:: :->rest'\n  case $state in\n    command)\n      local -a commands=(";
  for (const CommandTable& part : command.commands) {
    text += "\n        " + in_quotes(zsh_text(last_word(part.name)) + ":" + part.summary);
  }
  return text + fmt::format(
                    ")\n      _describe command commands ;;\n    rest)\n      (( $+functions[{0}-$words[1]] )) && "
                    "{0}-$words[1] ;;\n  esac\n}}\n\n",
                    name);
}

}  // namespace

std::string bash_completion(const CommandTable& dermis) {
  std::vector<std::string> names;
  std::string cases;
  std::string choices;
  for_each_command(dermis, [&](const CommandTable& command) {
    if (&command != &dermis) names.push_back("'" + command.name + "'");
    cases += bash_case(command);
    choices += bash_choices(command);
  });
  // Where nothing is offered, readline offers files.
  return kLicence + fmt::format(R"(_dermis() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD - 1]}} command=dermis
  local i words files others arguments
  for ((i = 1; i < COMP_CWORD; ++i)); do
    case "$command ${{COMP_WORDS[i]}}" in
      {}) command+=" ${{COMP_WORDS[i]}}" ;;
    esac
  done
  case $command in
{}  esac
  case "$command $before" in
{}  esac
  COMPREPLY=()
  if [[ $others == *" $before "* ]]; then
    compopt +o default
  elif [[ $files != *" $before "* && ($word == -* || $arguments == 0) ]]; then
    COMPREPLY=($(compgen -W "$words" -- "$word"))
  fi
}}
complete -o default -F _dermis dermis
)",
                                joined(names, " | "), cases, choices);
}

std::string zsh_completion(const CommandTable& dermis) {
  std::string functions;
  for_each_command(dermis, [&](const CommandTable& command) { functions += zsh_function(command); });
  return fmt::format("#compdef dermis\n{}\n{}_dermis \"$@\"\n", kLicence, functions);
}

}  // namespace dermis::app
