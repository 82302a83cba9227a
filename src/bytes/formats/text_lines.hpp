// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <istream>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::formats {

/// The lines of a text, LF or CRLF, without a byte order mark, of at most 32 MiB.
class TextLines {
 public:
  TextLines(std::unique_ptr<std::istream> in, std::string name);

  /// The next line, valid until the next call; false at the end.
  [[nodiscard]] Result<bool> next(std::string_view& line);

  /// The text ended without the end of its last line.
  [[nodiscard]] bool was_cut() const noexcept { return was_cut_; }
  /// It ended before a value that was to come.
  [[nodiscard]] bool ends_in_comma() const noexcept { return was_cut_ && line_.ends_with(','); }

  /// To the first line again; of a stream that can seek.
  [[nodiscard]] Status rewind();

  [[nodiscard]] const std::string& name() const noexcept { return name_; }
  /// Place of the last line: "name:line".
  [[nodiscard]] std::string place() const;
  /// Bad input at the last line.
  [[nodiscard]] Error error(const std::string& message) const;

 private:
  bool fill();

  std::unique_ptr<std::istream> in_;
  std::string name_;
  std::vector<char> piece_;  ///< Of the text,
  std::string_view rest_;    ///< and what of it is to come.
  std::string line_;
  std::size_t number_ = 0;
  bool was_cut_ = false;
};

/// Takes the cells of one line from the left. Blanks around a cell are dropped, and so are quotes; what is between
/// quotes holds together.
class Cells {
 public:
  enum class Separator {
    comma,
    any,  ///< One comma, or blanks; where the line has semicolons or tabs, one of these, and a comma belongs to a
          ///< number.
  };
  Cells(std::string_view line, Separator separator) noexcept;

  /// False when the line has no further cell.
  [[nodiscard]] bool next(std::string_view& cell) noexcept;
  /// The next one that is not empty.
  [[nodiscard]] bool next_filled(std::string_view& cell) noexcept;

 private:
  [[nodiscard]] bool ends_cell(char c) const noexcept;
  void skip_blanks() noexcept;

  std::string_view rest_;
  char separator_;  ///< Between two of them, there is a cell.
  bool blanks_separate_;
  bool at_end_;
};

/// A number, with a decimal point or comma; what stands for no reading (nothing, nan, B) is NaN.
[[nodiscard]] bool parse_reading(std::string_view text, float& value);

/// Reads the values of a row, all of `row`; what follows must be empty. Else says what is wrong with the line.
[[nodiscard]] Status parse_row(std::string_view line, Cells::Separator separator, std::span<float> row);

/// The factor on a reading in this unit: pressures become kilopascals, forces newtons, "raw" stays. Empty: the unit is
/// not known.
[[nodiscard]] std::optional<double> factor_of_unit(std::string_view unit);
/// The units of factor_of_unit(), for messages.
[[nodiscard]] std::string known_units();

}  // namespace dermis::bytes::formats
