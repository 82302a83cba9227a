// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/proposals/document.hpp"

#include <algorithm>
#include <cstddef>

namespace dermis::bytes::proposals {
namespace {

constexpr std::string_view kBetween = " \t\r\n";

/// How many brackets of both kinds are open behind the text, outside of quotes.
std::ptrdiff_t depth_of(std::string_view text) {
  std::ptrdiff_t depth = 0;
  bool is_quoted = false;
  for (const char c : text) {
    if (c == '"') is_quoted = !is_quoted;
    if (is_quoted) continue;
    depth += c == '[' || c == '{' ? 1 : 0;
    depth -= c == ']' || c == '}' ? 1 : 0;
  }
  return depth;
}

}  // namespace

bool is_document(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(kBetween);
  if (begin == std::string_view::npos || (text[begin] != '[' && text[begin] != '{')) return false;
  text.remove_prefix(begin);
  const std::size_t end = text.find('\n');
  const bool is_one_line = text.find_first_not_of(kBetween, std::min(end, text.size())) == std::string_view::npos;
  const bool has_commas = text.find(',') != std::string_view::npos;
  return has_commas && (is_one_line || depth_of(text.substr(0, end)) > 0);
}

std::string without_breaks(std::string_view text) {
  std::string plain(text);
  std::replace_if(
      plain.begin(), plain.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return plain;
}

std::vector<Line> pieces_of_document(std::string_view text, char opening, char closing) {
  std::vector<Line> pieces = lines_of(text, std::string(1, closing));
  for (Line& piece : pieces) {
    const std::size_t opened = piece.text.rfind(opening);
    const std::size_t from = opened == std::string_view::npos ? 0 : opened + 1;
    const std::size_t begin = std::min(piece.text.find_first_not_of(kBetween, from), piece.text.size());
    piece.text.remove_prefix(begin);
    piece.begin += begin;
    piece.size -= begin;
  }
  return pieces;
}

}  // namespace dermis::bytes::proposals
