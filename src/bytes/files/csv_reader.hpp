// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <istream>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::files {

/// Lines of a CSV file, read in large pieces. Takes LF and CRLF, a UTF-8 byte order mark and a last line without an
/// end, and passes over blank lines. Refuses lines of more than 32 MiB. Refuses texts whose first line has no commas
/// but semicolons or tabs, or quotes, or is UTF-16. The stream must outlive the reader.
class CsvReader {
 public:
  CsvReader(std::istream& in, std::string name);

  /// The next line that is not blank, valid until the next call; false at the end.
  [[nodiscard]] Result<bool> next_line(std::string_view& line);

  /// The text ended within the last line, or right after it.
  [[nodiscard]] bool was_cut() const noexcept { return was_cut_; }

  /// Number of the last line, from 1.
  [[nodiscard]] std::size_t line_number() const noexcept { return line_number_; }

  /// Place of the last line: "name:line".
  [[nodiscard]] std::string place() const;

  /// Bad input at the last line: "name:line: message".
  [[nodiscard]] Error error(std::string_view message) const;

 private:
  [[nodiscard]] bool fill();
  [[nodiscard]] bool take_raw_line(std::string_view& line);

  std::istream& in_;
  std::string name_;
  std::vector<char> buffer_;
  std::size_t begin_ = 0;    ///< First byte not yet given out.
  std::size_t scanned_ = 0;  ///< No line end in [begin_, scanned_).
  std::size_t end_ = 0;
  std::size_t line_number_ = 0;
  bool is_first_line_ = true;  ///< Of those that are not blank.
  bool was_cut_ = false;
};

/// Takes the cells of one line from the left. Blanks around a cell are dropped; quotes have no meaning.
class CsvCells {
 public:
  explicit CsvCells(std::string_view line) noexcept : rest_(line) {}

  /// False when the line has no further cell.
  [[nodiscard]] bool next(std::string_view& cell) noexcept;

 private:
  std::string_view rest_;
  bool at_end_ = false;
};

[[nodiscard]] std::vector<std::string_view> split_cells(std::string_view line);

[[nodiscard]] std::size_t count_cells(std::string_view line) noexcept;

/// Whether a line has as many cells as the header has columns; without its place.
[[nodiscard]] Status check_count(std::string_view line, std::size_t columns);

}  // namespace dermis::bytes::files
