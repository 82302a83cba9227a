// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/proposals/line_writer.hpp"

#include <iterator>
#include <string_view>

#include "bytes/proposals/tokens.hpp"

namespace dermis::bytes::proposals {
namespace {

/// Blanks of any length are the same in a pattern.
std::string literal(std::string_view text) {
  std::string result;
  for (const char c : text) {
    const bool is_second = c == ' ' && !result.empty() && (result.back() == ' ' || result.back() == '\t');
    if (c == '\t' && !result.empty() && result.back() == ' ') result.pop_back();
    if (!is_second) result += c;
    if (c == '{' || c == '}') result += c;
  }
  return result;
}

/// Brackets around readings need not be said.
std::string_view without_brackets(std::string_view text, bool at_end, bool at_begin) {
  constexpr std::string_view kBrackets = "[]()";
  const auto is_bracket = [&](char c) { return kBrackets.find(c) != std::string_view::npos; };
  std::string_view rest = text;
  while (at_end && !rest.empty() && is_bracket(rest.back())) rest.remove_suffix(1);
  while (at_begin && !rest.empty() && is_bracket(rest.front())) rest.remove_prefix(1);
  return rest.empty() ? text : rest;
}

}  // namespace

std::string pattern_of(const Line& line, const std::vector<Place>& places, std::size_t word_at, std::size_t word_size) {
  std::string pattern;
  std::size_t column = 0;
  auto place = places.begin();
  bool is_inside = false;  // of the readings of an array
  const auto& tokens = line.tokens;
  for (std::size_t k = 0; k < tokens.size(); ++k) {
    const std::string_view text = tokens[k].text;
    if (tokens[k].kind != Token::Kind::text) {
      if (!is_inside) pattern += "{" + place->field + "}";
      is_inside = ++column < place->end;
      if (!is_inside) ++place;
      continue;
    }
    const auto at = static_cast<std::size_t>(text.data() - line.text.data());
    const bool has_word = word_size > 0 && word_at >= at && word_at < at + text.size();
    const bool is_end = k + 1 == tokens.size();
    const bool begins_readings = k == 0 && place->role == layouts::Role::values;
    const bool is_before_readings = place != places.end() && place->role == layouts::Role::values;
    const bool is_behind_readings = place != places.begin() && std::prev(place)->role == layouts::Role::values;
    std::string_view kept = k == 0 ? text.substr(escape_sequences_at(text)) : text;
    const bool is_blank = k == 0 && kept.find_first_not_of(" \t") == std::string_view::npos;
    const bool says_nothing = is_blank || (begins_readings && is_passed_over(kept)) ||
                              (is_end && kept.find_first_not_of(" \t[](),;") == std::string_view::npos);
    if (has_word) {
      pattern += literal(text.substr(0, word_at - at)) + "{array}" + literal(text.substr(word_at - at + word_size));
    } else if (!is_inside && !says_nothing) {
      if (is_end) kept = kept.substr(0, kept.find_last_not_of(" \t") + 1);
      pattern += literal(without_brackets(kept, is_before_readings, is_behind_readings));
    }
  }
  return pattern;
}

void add_parts(const Line& line, const std::vector<Place>& places, std::vector<Part>& parts) {
  std::size_t column = 0;
  auto place = places.begin();
  for (const Token& token : line.tokens) {
    if (token.kind == Token::Kind::text) continue;
    const std::size_t begin = line.begin + static_cast<std::size_t>(token.text.data() - line.text.data());
    if (place == places.end()) return;
    parts.push_back({begin, begin + token.text.size(), place->role});
    if (++column >= place->end) ++place;
  }
}

}  // namespace dermis::bytes::proposals
