// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <string_view>

#include "command_texts.hpp"
#include "dermis/touch/frames/version.hpp"
#include "reference.hpp"

namespace dermis::app {
namespace {

/// Text for roff: what means something to it is escaped, and hyphens stay ASCII, so that options can be copied.
std::string roff(std::string_view text) {
  std::string escaped = text.starts_with('.') ? "\\&" : "";
  for (const char c : text) {
    switch (c) {
      case '\\': escaped += "\\e"; break;
      case '-': escaped += "\\-"; break;
      case '\'': escaped += "\\(aq"; break;
      case '"': escaped += "\\(dq"; break;
      case '~': escaped += "\\(ti"; break;
      case '^': escaped += "\\(ha"; break;
      default: escaped += c;
    }
  }
  return escaped;
}

std::string bold(std::string_view text) {
  return "\\fB" + roff(text) + "\\fR";
}

std::string italic(std::string_view text) {
  return "\\fI" + roff(text) + "\\fR";
}

/// "dermis circuit" as the name of a page, "dermis-circuit".
std::string page_name(std::string name) {
  std::replace(name.begin(), name.end(), ' ', '-');
  return name;
}

std::string list_of(const std::vector<std::string>& names) {
  return fmt::format("{}", fmt::join(names, ", "));
}

/// "--range FLOAT FLOAT", "--in TEXT ...", or the name of an argument.
std::string usage(const OptionRow& option, bool is_argument) {
  if (is_argument) return italic(option.names.front()) + (option.is_repeated ? " ..." : "");
  std::string usage;
  for (const std::string& name : option.names) usage += (usage.empty() ? "" : ", ") + bold(name);
  const std::string value = option.choices.empty() ? option.value : "NAME";
  for (int k = 0; k < option.values; ++k) usage += " " + italic(value);
  return usage + (option.is_repeated ? " ..." : "");
}

std::string entry(const OptionRow& option, bool is_argument) {
  return ".TP\n" + usage(option, is_argument) + "\n" + roff(whole_help(option, is_argument)) + "\n";
}

std::string entries(const CommandTable& command) {
  std::string text;
  for (const OptionRow& argument : command.arguments) text += entry(argument, true);
  for (const OptionRow& option : command.options) text += entry(option, false);
  return text;
}

std::string synopsis(const CommandTable& command) {
  std::string text = bold(command.name) + " [" + italic("option") + " ...]";
  for (const OptionRow& argument : command.arguments) {
    const std::string name = usage(argument, true);
    text += argument.is_required ? " " + name : " [" + name + "]";
  }
  if (command.needs_command) {
    text += " " + italic("command");
  } else if (!command.commands.empty()) {
    text += " [" + italic("command") + "]";
  }
  return text + "\n";
}

std::string heading(const std::string& name, const std::string& summary) {
  std::string title = name;
  std::transform(title.begin(), title.end(), title.begin(), [](unsigned char c) { return std::toupper(c); });
  return fmt::format(".TH {} 1 \"\" \"dermis {}\" \"dermis\"\n.SH NAME\n{} \\- {}\n", roff(title), DERMIS_VERSION,
                     roff(name), roff(summary));
}

/// The end of every page.
std::string closing(const std::vector<std::string>& pages) {
  std::string text =
      ".SH EXIT STATUS\n0: done; 1: the work failed, or less was read than there should be; 2: bad usage or input.\n"
      ".SH SEE ALSO\n";
  for (const std::string& page : pages) {
    text += ".BR " + roff(page) + " (1)" + (page == pages.back() ? "\n" : " ,\n");
  }
  return text;
}

ManualPage page_of(const CommandTable& command) {
  const std::string name = page_name(command.name);
  const CommandText said = command_text(command.name);
  std::string text = heading(name, command.summary) + ".SH SYNOPSIS\n" + synopsis(command);
  for (const CommandTable& part : command.commands) text += ".br\n" + synopsis(part);
  if (!said.about.empty()) text += ".SH DESCRIPTION\n" + roff(said.about) + "\n";
  text += ".SH OPTIONS\n" + entries(command);
  for (const CommandTable& part : command.commands) {
    const CommandText of_part = command_text(part.name);
    text += fmt::format(".SS {}\n{}. {}\n{}", roff(part.name), roff(part.summary), roff(of_part.about), entries(part));
  }
  if (!said.examples.empty()) text += fmt::format(".SH EXAMPLES\n.nf\n{}\n.fi\n", roff(said.examples));
  return {name, text + closing({"dermis"})};
}

ManualPage main_page(const CommandTable& dermis) {
  const std::size_t colon = dermis.summary.find(": ");
  const std::string summary = colon == std::string::npos ? dermis.summary : dermis.summary.substr(colon + 2);
  std::string text = heading(dermis.name, summary) + ".SH SYNOPSIS\n" + synopsis(dermis) + ".SH COMMANDS\n";
  std::vector<std::string> pages;
  for (const CommandTable& command : dermis.commands) {
    pages.push_back(page_name(command.name));
    text += ".TP\n" + bold(command.name) + "\n" + roff(command.summary) + ".\n";
  }
  return {dermis.name, text + ".SH OPTIONS\n" + entries(dermis) + closing(pages)};
}

}  // namespace

std::string whole_help(const OptionRow& option, bool is_argument) {
  std::string text = option.help;
  if (!option.choices.empty()) text += ". One of " + list_of(option.choices);
  if (option.is_required && !is_argument) text += ". Required";
  if (!option.default_value.empty()) text += ". Default: " + option.default_value;
  if (!option.needs.empty()) text += ". Needs " + list_of(option.needs);
  if (!option.excludes.empty()) text += ". Not with " + list_of(option.excludes);
  return text + ".";
}

std::vector<ManualPage> manual_pages(const CommandTable& dermis) {
  std::vector<ManualPage> pages{main_page(dermis)};
  for (const CommandTable& command : dermis.commands) pages.push_back(page_of(command));
  return pages;
}

}  // namespace dermis::app
