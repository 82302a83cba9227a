// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <regex>
#include <string>
#include <string_view>
#include <vector>

#include "command_texts.hpp"
#include "reference.hpp"

namespace dermis::app {
namespace {

constexpr std::string_view kWritten = "<!-- Written by 'make reference' from the texts of apps/dermis. -->\n\n";
constexpr std::string_view kIntroduction =
    "`dermis help` lists these commands, and `dermis help COMMAND` shows the options of one. The manual pages say the "
    "same (`man dermis-run`); `dermis reference ~/.local` writes them, and the completion of bash and zsh. [JSON]"
    "(json.md) describes what `--json` prints.\n";

/// "Look after" as "look-after.md".
std::string file_of(std::string group) {
  std::transform(group.begin(), group.end(), group.begin(),
                 [](unsigned char c) { return c == ' ' ? '-' : static_cast<char>(std::tolower(c)); });
  return group + ".md";
}

/// "dermis doctor check" as "doctor check".
std::string title_of(const CommandTable& command) {
  return command.name.substr(command.name.find(' ') + 1);
}

/// Text for a cell or a paragraph: pages of the documentation become links, what Markdown would take is escaped.
std::string markdown(const std::string& text) {
  static const std::regex kPage("docs/([a-z-]+\\.md)(#[a-z0-9-]+)?");
  static const std::regex kMarks("([|<*_])");
  return std::regex_replace(std::regex_replace(text, kMarks, "\\$1"), kPage, "[$1](../$1$2)");
}

std::string options_of(const CommandTable& command) {
  std::string rows;
  for (const OptionRow& argument : command.arguments) {
    const std::string more = argument.is_repeated ? "..." : "";
    rows += fmt::format("| `{}{}` | {} |\n", argument.names.front(), more, markdown(whole_help(argument, true)));
  }
  std::string group;
  for (const OptionRow& option : command.options) {
    if (option.names.back() == "--help") continue;
    if (option.group != group && command.options.front().group != command.options.back().group) {
      rows += fmt::format("| **{}** | |\n", option.group);
    }
    group = option.group;
    std::string usage = option.names.back();
    for (int k = 0; k < option.values; ++k) usage += " " + (option.choices.empty() ? option.value : "NAME");
    rows +=
        fmt::format("| `{}` | {} |\n", usage + (option.is_repeated ? "..." : ""), markdown(whole_help(option, false)));
  }
  return rows.empty() ? rows : "\n| option | meaning |\n|---|---|\n" + rows;
}

std::string section_of(const CommandTable& command, const std::string& marks) {
  const CommandText text = command_text(command.name);
  std::string section = fmt::format("\n{} {}\n\n{}.", marks, title_of(command), markdown(command.summary));
  if (!text.about.empty()) section += " " + markdown(std::string(text.about));
  section += "\n";
  if (!text.examples.empty()) section += fmt::format("\n```sh\n{}\n```\n", text.examples);
  section += options_of(command);
  for (const CommandTable& part : command.commands) section += section_of(part, marks + "#");
  return section;
}

/// The name of a command, what it does, and where its options are.
std::string overview(const CommandTable& command, const std::string& marks, const std::string& file) {
  std::string anchor = title_of(command);
  std::replace(anchor.begin(), anchor.end(), ' ', '-');
  std::string text = fmt::format("\n{} {}\n\n{}: [options](commands/{}#{}).\n", marks, title_of(command),
                                 markdown(command.summary), file, anchor);
  for (const CommandTable& part : command.commands) text += overview(part, marks + "#", file);
  return text;
}

}  // namespace

std::vector<ManualPage> command_documents(const CommandTable& dermis) {
  std::string all = fmt::format("{}# Command line\n\n{}\n{}", kWritten, kIntroduction, general_text());
  std::vector<ManualPage> pages;
  std::string group;
  for (const CommandTable& command : dermis.commands) {
    const std::string file = file_of(command.group);
    if (command.group != group) {
      group = command.group;
      all += fmt::format("\n## {}\n", group);
      pages.push_back({"commands/" + file, fmt::format("{}# {}\n", kWritten, group)});
    }
    all += overview(command, "###", file);
    pages.back().text += section_of(command, "##");
  }
  pages.push_back({"command-line.md", all});
  return pages;
}

}  // namespace dermis::app
