// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <istream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::files {

/// A CSV file of texts under a header of names. Line ends, blanks and commas are as in every CSV file of the project.
class CsvTable {
 public:
  [[nodiscard]] static Result<CsvTable> read(const std::string& path);
  /// The same from a stream; `name` stands for the path in messages. Fails on a repeated column, on a line with another
  /// number of values than the header, and beyond 256 MiB of cells.
  [[nodiscard]] static Result<CsvTable> read(std::istream& in, const std::string& name);

  [[nodiscard]] std::size_t rows() const noexcept { return lines_.size(); }

  [[nodiscard]] const std::vector<std::string>& columns() const noexcept { return columns_; }
  /// Index of a column; empty if there is none of the name.
  [[nodiscard]] std::optional<std::size_t> column(std::string_view name) const;
  /// Fails if there is none of the name, and names the columns of the file.
  [[nodiscard]] Result<std::size_t> needed_column(std::string_view name) const;

  [[nodiscard]] const std::string& at(std::size_t row, std::size_t column) const;

  /// A whole number of 0 or more.
  [[nodiscard]] Result<std::size_t> count_at(std::size_t row, std::size_t column) const;
  /// A finite number.
  [[nodiscard]] Result<double> number_at(std::size_t row, std::size_t column) const;

  /// Bad input at a row: "name:line: message".
  [[nodiscard]] Error error(std::size_t row, std::string_view message) const;
  /// Bad input of the whole file: "name: message".
  [[nodiscard]] Error error(std::string_view message) const;

 private:
  std::string name_;
  std::vector<std::string> columns_;
  std::vector<std::string> cells_;  ///< [rows, columns]
  std::vector<std::size_t> lines_;  ///< Of each row, from 1.
};

}  // namespace dermis::bytes::files
