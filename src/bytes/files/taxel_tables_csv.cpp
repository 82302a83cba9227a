// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/taxel_tables_csv.hpp"

#include <cassert>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "bytes/files/csv_reader.hpp"
#include "dermis/bytes/files/input.hpp"
#include "dermis/bytes/files/text.hpp"

namespace dermis::bytes::files {
namespace {

bool has_number(std::string_view line) {
  CsvCells cells(line);
  double value = 0.0;
  for (std::string_view cell; cells.next(cell);) {
    if (parse_number(cell, value)) return true;
  }
  return false;
}

std::string count_of(std::size_t count, const char* thing) {
  return std::to_string(count) + " " + thing + (count == 1 ? "" : "s");
}

}  // namespace

struct TaxelTablesReader::State {
  std::unique_ptr<std::istream> in;
  CsvReader csv;
  std::size_t rows;
  std::size_t cols;
  TableValues values;
  bool is_first_line = true;
  std::size_t line = 0;

  Result<bool> next_line(std::string_view& text);
  Status read_row(std::string_view text, std::span<double> row) const;
  std::optional<Error> read_cell(std::string_view cell, std::size_t col, double& value) const;
};

Result<bool> TaxelTablesReader::State::next_line(std::string_view& text) {
  Result<bool> got_line = csv.next_line(text);
  if (!std::exchange(is_first_line, false) || !got_line || !*got_line || has_number(text)) return got_line;
  return csv.next_line(text);  // after the header
}

Status TaxelTablesReader::State::read_row(std::string_view text, std::span<double> row) const {
  if (const std::size_t count = count_cells(text); count != cols) {
    return csv.error("has " + count_of(count, "value") + ", the array " + count_of(cols, "column") + "; write " +
                     std::to_string(rows) + " lines of " + count_of(cols, "number") + " a frame, with commas");
  }
  CsvCells cells(text);
  std::string_view cell;
  for (std::size_t col = 0; col < cols; ++col) {
    static_cast<void>(cells.next(cell));
    if (std::optional<Error> mistake = read_cell(cell, col, row[col])) return *std::move(mistake);
  }
  return Done{};
}

std::optional<Error> TaxelTablesReader::State::read_cell(std::string_view cell, std::size_t col, double& value) const {
  const bool is_finite = parse_number(cell, value) && std::isfinite(value);
  if (is_finite && (values == TableValues::finite || value >= 0.0)) return std::nullopt;
  return csv.error("value " + std::to_string(col + 1) + ": " + in_quotes(cell) + " is not a " +
                   (is_finite ? "conductance; write siemens, 0 or more" : "finite number"));
}

TaxelTablesReader::TaxelTablesReader(std::unique_ptr<State> state) : state_(std::move(state)) {}
TaxelTablesReader::TaxelTablesReader(TaxelTablesReader&&) noexcept = default;
TaxelTablesReader& TaxelTablesReader::operator=(TaxelTablesReader&&) noexcept = default;
TaxelTablesReader::~TaxelTablesReader() = default;

Result<TaxelTablesReader> TaxelTablesReader::open(const std::string& path, std::size_t rows, std::size_t cols,
                                                  TableValues values) {
  Result<std::unique_ptr<std::istream>> in = open_input(path);
  if (!in) return in.error();
  return open(*std::move(in), path, rows, cols, values);
}

TaxelTablesReader TaxelTablesReader::open(std::unique_ptr<std::istream> in, const std::string& name, std::size_t rows,
                                          std::size_t cols, TableValues values) {
  assert(rows > 0 && cols > 0);
  std::istream& stream = *in;
  return TaxelTablesReader(std::make_unique<State>(State{std::move(in), CsvReader(stream, name), rows, cols, values}));
}

Result<bool> TaxelTablesReader::next(std::span<double> table) {
  assert(table.size() == state_->rows * state_->cols);
  std::string_view text;
  for (std::size_t row = 0; row < state_->rows; ++row) {
    const Result<bool> got_line = state_->next_line(text);
    if (!got_line) return got_line.error();
    if (!*got_line && row == 0) return false;
    if (!*got_line) {
      return state_->csv.error("the file ends after " + count_of(row, "line") + " of a frame; the array has " +
                               count_of(state_->rows, "row"));
    }
    if (row == 0) state_->line = state_->csv.line_number();
    if (const Status read = state_->read_row(text, table.subspan(row * state_->cols, state_->cols)); !read) {
      return read.error();
    }
  }
  return true;
}

std::size_t TaxelTablesReader::line() const noexcept {
  return state_->line;
}

TaxelTablesWriter::TaxelTablesWriter(AtomicFile file, std::size_t rows, std::size_t cols)
    : file_(std::move(file)), rows_(rows), cols_(cols) {}

Result<TaxelTablesWriter> TaxelTablesWriter::create(const std::string& path, std::size_t rows, std::size_t cols) {
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return file.error();
  return TaxelTablesWriter(*std::move(file), rows, cols);
}

Status TaxelTablesWriter::write(std::span<const double> table) {
  assert(table.size() == rows_ * cols_);
  text_.clear();
  if (!std::exchange(is_first_, false)) text_ += '\n';
  for (std::size_t taxel = 0; taxel < table.size(); ++taxel) {
    append_number(text_, table[taxel]);
    text_ += (taxel + 1) % cols_ == 0 ? '\n' : ',';
  }
  file_.write(text_);
  return file_.status();
}

Status TaxelTablesWriter::commit() {
  return file_.commit();
}

}  // namespace dermis::bytes::files
