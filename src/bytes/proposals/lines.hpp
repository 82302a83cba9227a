// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace dermis::bytes::proposals {

/// A piece of a line.
struct Token {
  enum class Kind { text, number, clock, datetime };
  Kind kind = Kind::text;
  std::string_view text;
  double value = 0.0;     ///< number
  bool has_mark = false;  ///< Of hexadecimal digits among decimal numbers: "0x4F", or "*4F" at the end of a line
};

/// How the numbers of a text are written.
struct Numerals {
  char decimal_point = '.';
  bool is_hexadecimal = false;
  std::size_t width = 0;    ///< Digits of a number, where nothing stands between them.
  std::string separator{};  ///< Between readings, where it is an unusual one.
};

struct Line {
  std::size_t begin = 0;  ///< Its place in the text.
  std::size_t size = 0;   ///< With its end.
  std::string_view text;  ///< Without.
  std::vector<Token> tokens{};
  std::string skeleton{};  ///< The same for lines that are built alike: its text, and how many numbers stand where.
};

/// The lines of a text; `line_end` as line_end_of() gives it. The last one may lack its end.
[[nodiscard]] std::vector<Line> lines_of(std::string_view text, const std::string& line_end);

/// The ways in which the numbers of the lines may be written.
[[nodiscard]] std::vector<Numerals> numerals_of(const std::vector<Line>& lines);

/// Cuts each line into tokens, and finds its skeleton.
void tokenise(std::vector<Line>& lines, Numerals& numerals);

/// Blanks, brackets, and one comma or semicolon, or what the numerals say.
[[nodiscard]] bool is_separator(std::string_view text, const Numerals& numerals);

/// Blanks and brackets, which layouts pass over.
[[nodiscard]] bool is_passed_over(std::string_view text);

}  // namespace dermis::bytes::proposals
