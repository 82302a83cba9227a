// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/csv_table.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <memory>
#include <set>

#include "bytes/files/csv_reader.hpp"
#include "dermis/bytes/files/input.hpp"
#include "dermis/bytes/files/text.hpp"

namespace dermis::bytes::files {
namespace {

constexpr std::size_t kMostBytes = std::size_t{256} << 20U;  // of all cells in memory

}  // namespace

Result<CsvTable> CsvTable::read(const std::string& path) {
  const Result<std::unique_ptr<std::istream>> in = open_input(path);
  if (!in) return in.error();
  return read(**in, path);
}

Result<CsvTable> CsvTable::read(std::istream& in, const std::string& name) {
  CsvTable table;
  table.name_ = name;
  CsvReader csv(in, name);
  std::string_view line;
  Result<bool> more = csv.next_line(line);
  if (!more) return more.error();
  if (!*more) return csv.error("is empty; a line with the names of its columns is expected");
  for (const std::string_view cell : split_cells(line)) table.columns_.emplace_back(cell);
  const std::set<std::string> names(table.columns_.begin(), table.columns_.end());
  if (names.size() != table.columns_.size()) return csv.error("names a column twice");
  std::size_t bytes = 0;
  while (true) {
    more = csv.next_line(line);
    if (!more) return more.error();
    if (!*more) return table;
    if (const Status right = check_count(line, table.columns_.size()); !right) return csv.error(right.error().message);
    bytes += line.size() + table.columns_.size() * sizeof(std::string);
    if (bytes > kMostBytes) return csv.error("is beyond 256 MiB of cells; divide the table");
    for (const std::string_view cell : split_cells(line)) table.cells_.emplace_back(cell);
    table.lines_.push_back(csv.line_number());
  }
}

std::optional<std::size_t> CsvTable::column(std::string_view name) const {
  const auto found = std::find(columns_.begin(), columns_.end(), name);
  if (found == columns_.end()) return std::nullopt;
  return static_cast<std::size_t>(found - columns_.begin());
}

Result<std::size_t> CsvTable::needed_column(std::string_view name) const {
  const std::optional<std::size_t> found = column(name);
  if (found) return *found;
  std::string names;
  for (const std::string& each : columns_) names += (names.empty() ? "" : ",") + each;
  return error("has no column " + in_quotes(name) + "; its header is " + in_quotes(names));
}

const std::string& CsvTable::at(std::size_t row, std::size_t column) const {
  assert(row < rows() && column < columns_.size());
  return cells_[row * columns_.size() + column];
}

Result<std::size_t> CsvTable::count_at(std::size_t row, std::size_t column) const {
  std::size_t count = 0;
  if (parse_number(at(row, column), count)) return count;
  return error(row, columns_[column] + " " + in_quotes(at(row, column)) + " is not a whole number of 0 or more");
}

Result<double> CsvTable::number_at(std::size_t row, std::size_t column) const {
  double number = 0.0;
  if (parse_number(at(row, column), number) && std::isfinite(number)) return number;
  return error(row, columns_[column] + " " + in_quotes(at(row, column)) + " is not a number");
}

Error CsvTable::error(std::size_t row, std::string_view message) const {
  return bad_input(name_ + ":" + std::to_string(lines_[row]) + ": " + std::string(message));
}

Error CsvTable::error(std::string_view message) const {
  return bad_input(name_ + ": " + std::string(message));
}

}  // namespace dermis::bytes::files
