// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/proposals/lines.hpp"

#include <algorithm>
#include <map>

#include "bytes/proposals/tokens.hpp"

namespace dermis::bytes::proposals {
namespace {

constexpr std::string_view kBlanks = " \t";
constexpr std::string_view kPassedOver = " \t[]()";

/// What is the same in lines that are built alike: blanks of any length, no brackets and separators at the ends.
std::string plain(std::string_view text, bool is_first, bool is_last) {
  if (is_first) text.remove_prefix(escape_sequences_at(text));
  if ((is_first || is_last) && text.find_first_not_of(" \t[](),;") == std::string_view::npos) return {};
  std::string result;
  for (const char c : text) {
    const bool is_blank = kBlanks.find(c) != std::string_view::npos;
    const bool is_control = static_cast<unsigned char>(c) < 0x05;  // these stand for what is no text
    if (!is_blank || result.empty() || result.back() != ' ') result += is_blank ? ' ' : is_control ? '?' : c;
  }
  return result;
}

std::string skeleton_of(const std::vector<Token>& tokens, const Numerals& numerals) {
  std::string skeleton;
  std::size_t numbers = 0;
  const auto end_run = [&] {
    if (numbers > 0) skeleton += "\x01" + std::to_string(numbers) + "\x02";
    numbers = 0;
  };
  for (std::size_t k = 0; k < tokens.size(); ++k) {
    const Token& token = tokens[k];
    const bool joins = k > 0 && k + 1 < tokens.size() && tokens[k - 1].kind == Token::Kind::number &&
                       tokens[k + 1].kind == Token::Kind::number;
    if (token.kind == Token::Kind::number) {
      ++numbers;
    } else if (token.kind != Token::Kind::text) {
      end_run();
      skeleton += token.kind == Token::Kind::clock ? "\x03" : "\x04";
    } else if (!joins || !is_separator(token.text, numerals)) {
      end_run();
      skeleton += plain(token.text, k == 0, k + 1 == tokens.size());
    }
  }
  end_run();
  return skeleton;
}

std::string_view without_blanks(std::string_view text) {
  const std::size_t begin = std::min(text.find_first_not_of(kBlanks), text.size());
  return text.substr(begin, text.find_last_not_of(kBlanks) + 1 - begin);
}

/// The text between most numbers, where layouts must be told.
std::string unusual_separator(const std::vector<Line>& lines, const Numerals& numerals) {
  std::map<std::string_view, std::size_t> counts;
  std::size_t all = 0;
  for (const Line& line : lines) {
    for (std::size_t k = 1; k + 1 < line.tokens.size(); ++k) {
      const bool is_between = line.tokens[k].kind == Token::Kind::text &&
                              line.tokens[k - 1].kind == Token::Kind::number &&
                              line.tokens[k + 1].kind == Token::Kind::number;
      if (!is_between) continue;
      ++counts[without_blanks(line.tokens[k].text)];
      ++all;
    }
  }
  const auto most =
      std::max_element(counts.begin(), counts.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  if (most == counts.end() || 3 * most->second < 2 * all || is_separator(most->first, numerals)) return {};
  const std::string_view separator = most->first;
  const bool is_hexadecimal_mark = separator.ends_with("0x") || separator.ends_with("0X");
  const std::string_view signs = separator.substr(0, separator.size() - (is_hexadecimal_mark ? 2 : 0));
  const bool has_letters =
      signs.find_first_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ") != std::string_view::npos;
  return has_letters || separator.size() > 8 ? std::string() : std::string(separator);
}

}  // namespace

std::vector<Line> lines_of(std::string_view text, const std::string& line_end) {
  const char end_byte = line_end.empty() ? '\n' : line_end.back();
  std::vector<Line> lines;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(end_byte, at), text.size() - 1);
    Line line{.begin = at, .size = end + 1 - at, .text = text.substr(at, end + 1 - at)};
    const std::string& whole = line_end.empty() ? "\r\n" : line_end;
    if (line.text.back() == end_byte) line.text.remove_suffix(1);
    for (std::size_t k = whole.size() - 1; k > 0 && line.text.ends_with(whole[k - 1]); --k) line.text.remove_suffix(1);
    lines.push_back(std::move(line));
    at = end + 1;
  }
  return lines;
}

bool is_passed_over(std::string_view text) {
  return text.find_first_not_of(kPassedOver) == std::string_view::npos;
}

bool is_separator(std::string_view text, const Numerals& numerals) {
  if (!numerals.separator.empty()) {
    const std::size_t at = text.find(numerals.separator);
    return at != std::string_view::npos && is_passed_over(text.substr(0, at)) &&
           is_passed_over(text.substr(at + numerals.separator.size()));
  }
  std::size_t signs = 0;
  for (const char c : text) {
    const bool is_sign = c == ';' || (c == ',' && numerals.decimal_point != ',');
    if (!is_sign && kPassedOver.find(c) == std::string_view::npos) return false;
    signs += is_sign ? 1 : 0;
  }
  const bool opens_alone = text.find('(') != std::string_view::npos && text.find(')') == std::string_view::npos;
  return signs <= 1 && (signs == 1 || !opens_alone);
}

void tokenise(std::vector<Line>& lines, Numerals& numerals) {
  for (Line& line : lines) line.tokens = tokens_of(line.text, numerals);
  numerals.separator = unusual_separator(lines, numerals);
  for (Line& line : lines) line.skeleton = skeleton_of(line.tokens, numerals);
}

}  // namespace dermis::bytes::proposals
