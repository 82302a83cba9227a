// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <algorithm>
#include <cctype>
#include <map>

#include "bytes/proposals/lines.hpp"
#include "dermis/bytes/files/numbers.hpp"

namespace dermis::bytes::proposals {
namespace {

using files::is_digit;

constexpr std::size_t kLinesLooked = 400;

bool is_hexadecimal(char c) {
  return std::isxdigit(static_cast<unsigned char>(c)) != 0;
}

/// Without those that are labels: A0 of "A0: 512".
std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::size_t at = 0; at < line.size();) {
    std::size_t end = at;
    while (end < line.size() && (std::isalnum(static_cast<unsigned char>(line[end])) != 0)) ++end;
    const bool is_label = end < line.size() && (line[end] == ':' || line[end] == '=');
    if (end > at && !is_label) words.push_back(line.substr(at, end - at));
    at = std::max(end, at + 1);
  }
  return words;
}

/// Hexadecimal digits, where nearly all words have them, as many each, and some have letters.
std::vector<Numerals> hexadecimal_numerals(const std::vector<Line>& lines) {
  std::size_t words = 0;
  std::size_t hexadecimal = 0;
  std::size_t with_marks = 0;    // 0x
  std::size_t with_letters = 0;  // but at the ends of a line, where checksums stand
  std::map<std::size_t, std::size_t> sizes;
  for (std::size_t k = 0; k < std::min(lines.size(), kLinesLooked); ++k) {
    const std::vector<std::string_view> of_line = words_of(lines[k].text);
    for (std::size_t at = 0; at < of_line.size(); ++at) {
      std::string_view word = of_line[at];
      const bool is_at_end = of_line.size() > 2 && (at == 0 || at + 1 == of_line.size());
      ++words;
      const bool has_mark = word.size() > 2 && (word.starts_with("0x") || word.starts_with("0X"));
      if (has_mark) word.remove_prefix(2);
      if (!std::all_of(word.begin(), word.end(), is_hexadecimal)) continue;
      ++hexadecimal;
      with_marks += has_mark ? 1 : 0;
      with_letters += !has_mark && !is_at_end && !std::all_of(word.begin(), word.end(), is_digit) ? 1 : 0;
      ++sizes[has_mark ? 2 : word.size()];
    }
  }
  const auto usual =
      std::max_element(sizes.begin(), sizes.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  const bool are_marked = 2 * with_marks > words;
  if (words == 0 || 10 * hexadecimal < 7 * words || (!are_marked && 50 * with_letters < words)) return {};
  const std::size_t size = usual->first;
  const bool are_equal = 10 * usual->second >= 6 * hexadecimal;
  if (are_equal && size >= 2 && size <= 8) return {Numerals{.is_hexadecimal = true}};
  std::vector<Numerals> packed;
  for (const std::size_t width : {4U, 3U, 2U}) {
    if (are_equal && size > 8 && size % width == 0) packed.push_back({.is_hexadecimal = true, .width = width});
  }
  return packed;
}

/// Decimal commas, where nearly all cells between semicolons or tabs have one.
bool has_decimal_commas(const std::vector<Line>& lines) {
  std::size_t with = 0;
  std::size_t against = 0;
  for (std::size_t k = 0; k < std::min(lines.size(), kLinesLooked); ++k) {
    const std::string_view line = lines[k].text;
    const bool has_semicolons = line.find(';') != std::string_view::npos;
    const std::string_view ends = has_semicolons ? ";" : "\t ";
    if (line.find_first_of(ends) >= line.size() - std::min<std::size_t>(line.size(), 1)) continue;  // two readings
    for (std::size_t at = 0; at < line.size();) {
      const std::size_t end = std::min(line.find_first_of(ends, at), line.size());
      const std::string_view cell = line.substr(at, end - at);
      const std::size_t comma = cell.find(',');
      const bool is_fraction = comma != std::string_view::npos && comma > 0 && comma + 1 < cell.size() &&
                               is_digit(cell[comma - 1]) && is_digit(cell[comma + 1]);
      if (is_fraction && cell.find(',', comma + 1) == std::string_view::npos &&
          cell.find('.') == std::string_view::npos)
        ++with;
      if (cell.find(',', std::min(comma, cell.size() - 1) + 1) != std::string_view::npos ||
          cell.find('.') != std::string_view::npos || (comma != std::string_view::npos && !is_fraction))
        ++against;
      at = end + 1;
    }
  }
  return with > 10 && with > 10 * against;
}

}  // namespace

std::vector<Numerals> numerals_of(const std::vector<Line>& lines) {
  std::vector<Numerals> numerals = hexadecimal_numerals(lines);
  if (numerals.empty()) numerals.push_back({.decimal_point = has_decimal_commas(lines) ? ',' : '.'});
  return numerals;
}

}  // namespace dermis::bytes::proposals
