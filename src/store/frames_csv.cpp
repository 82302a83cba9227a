// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/store/frames_csv.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <optional>
#include <string_view>
#include <utility>

#include "dermis/core/array_description.hpp"
#include "store/csv_reader.hpp"
#include "store/input.hpp"
#include "store/taxel_text.hpp"
#include "store/text.hpp"

namespace dermis::store {
namespace {

enum class Column { time, temperature, supply };

constexpr std::array<const char*, 3> kColumnNames{"time_s", "temperature_celsius", "supply_v"};
constexpr std::size_t kMaxColumns = kMaxLines * kMaxLines + kColumnNames.size();

const char* name_of(Column column) {
  return kColumnNames[static_cast<std::size_t>(column)];
}

std::optional<Column> column_named(std::string_view name) {
  const auto* const found = std::find(kColumnNames.begin(), kColumnNames.end(), name);
  if (found == kColumnNames.end()) return std::nullopt;
  return static_cast<Column>(found - kColumnNames.begin());
}

std::string size_text(std::size_t rows, std::size_t cols) {
  return std::to_string(rows) + "x" + std::to_string(cols);
}

using Cells = std::vector<std::string_view>;

bool are_taxels_in_order(const Cells& cells, std::size_t first, std::size_t rows, std::size_t cols) {
  if (cells.size() - first != rows * cols) return false;
  for (std::size_t i = 0; i < rows * cols; ++i) {
    if (cells[first + i] != taxel_name(i / cols, i % cols)) return false;
  }
  return true;
}

/// Why the cells from `first` on are not the taxels of the array.
std::string taxel_mistake(const Cells& cells, std::size_t first, std::size_t rows, std::size_t cols) {
  if (const std::optional<TaxelPlace> last = parse_taxel(cells.back())) {
    const bool is_other_size = last->row + 1 != rows || last->col + 1 != cols;
    const bool is_grid = last->row < cells.size() && last->col < cells.size();
    if (is_other_size && is_grid && are_taxels_in_order(cells, first, last->row + 1, last->col + 1)) {
      return "has " + size_text(last->row + 1, last->col + 1) + " taxels, the array is " + size_text(rows, cols);
    }
  }
  for (std::size_t i = 0; i < rows * cols; ++i) {
    const std::string expected = taxel_name(i / cols, i % cols);
    const std::string_view cell = first + i < cells.size() ? cells[first + i] : "";
    if (cell == expected) continue;
    if (!cell.empty() && !parse_taxel(cell) && !column_named(cell)) {
      return "unknown column " + in_quotes(cell) + "; expected " + expected;
    }
    const bool is_absent = std::find(cells.begin(), cells.end(), expected) == cells.end();
    if (is_absent) return "column " + expected + " is missing; the array is " + size_text(rows, cols);
    return "column " + in_quotes(cell) + " stands where " + expected +
           " is expected; write the taxels row by row, after all other columns";
  }
  return "unknown column " + in_quotes(cells[first + rows * cols]) + " after the last taxel of a " +
         size_text(rows, cols) + " array; remove it";
}

/// The columns before the taxels, or what is wrong with the header.
Result<std::vector<Column>> parse_header(const Cells& cells, std::size_t rows, std::size_t cols) {
  std::vector<Column> columns;
  for (const std::string_view cell : cells) {
    const std::optional<Column> column = column_named(cell);
    if (!column) break;
    if (std::find(columns.begin(), columns.end(), *column) != columns.end()) {
      return bad_input("column " + in_quotes(cell) + " stands twice; remove one");
    }
    columns.push_back(*column);
  }
  if (std::find(cells.begin(), cells.end(), name_of(Column::time)) == cells.end()) {
    return bad_input("column time_s is missing; the header begins with time_s");
  }
  const std::size_t first = columns.size();
  if (first < cells.size() && cells[first] != taxel_name(0, 0) && !parse_taxel(cells[first])) {
    return bad_input("unknown column " + in_quotes(cells[first]) +
                     "; before r0c0 stand time_s, temperature_celsius and supply_v");
  }
  if (!are_taxels_in_order(cells, first, rows, cols)) return bad_input(taxel_mistake(cells, first, rows, cols));
  return columns;
}

}  // namespace

struct FramesCsvReader::State {
  std::unique_ptr<std::istream> in;
  CsvReader csv;
  std::size_t rows;
  std::size_t cols;
  std::vector<Column> columns;

  Status read_header();
  std::optional<Error> read_value(Column column, std::string_view cell, RawFrame& frame) const;
  Status read_frame(std::string_view line, RawFrame& frame) const;
  Error count_error(std::size_t taxel, std::string_view cell) const;
};

Status FramesCsvReader::State::read_header() {
  std::string_view line;
  const Result<bool> got_line = csv.next_line(line);
  if (!got_line) return got_line.error();
  if (!*got_line) return csv.error("is empty; expected a header time_s,r0c0,...");
  if (count_cells(line) > kMaxColumns) {
    return csv.error("has " + std::to_string(count_cells(line)) + " columns; at most 1024x1024 taxels can be read");
  }
  if (count_cells(line) == 1 && line.find(';') != std::string_view::npos) {
    return csv.error("has semicolons between its values; write commas");
  }
  Result<std::vector<Column>> parsed = parse_header(split_cells(line), rows, cols);
  if (!parsed) return csv.error(parsed.error().message);
  columns = std::move(*parsed);
  return Done{};
}

std::optional<Error> FramesCsvReader::State::read_value(Column column, std::string_view cell, RawFrame& frame) const {
  if (column == Column::time) {
    if (parse_seconds(cell, frame.time)) return std::nullopt;
    return csv.error("column time_s: " + in_quotes(cell) + " is not a time; write seconds of at most 9e9");
  }
  std::optional<double>& target = column == Column::supply ? frame.supply_v : frame.temperature_celsius;
  if (cell.empty()) {
    target.reset();
    return std::nullopt;
  }
  double value = 0.0;
  if (!parse_number(cell, value)) {
    return csv.error(std::string("column ") + name_of(column) + ": " + in_quotes(cell) +
                     " is not a number; leave the cell empty where there is no value");
  }
  target = value;
  return std::nullopt;
}

Status FramesCsvReader::State::read_frame(std::string_view line, RawFrame& frame) const {
  const std::size_t taxel_count = rows * cols;
  const std::size_t header_size = columns.size() + taxel_count;
  if (const std::size_t size = count_cells(line); size != header_size) {
    return csv.error("has " + std::to_string(size) + " values, the header " + std::to_string(header_size));
  }
  frame.temperature_celsius.reset();
  frame.supply_v.reset();
  frame.counts.resize(taxel_count);
  CsvCells cells(line);
  std::string_view cell;
  for (const Column column : columns) {
    static_cast<void>(cells.next(cell));
    if (std::optional<Error> mistake = read_value(column, cell, frame)) return *std::move(mistake);
  }
  for (std::size_t taxel = 0; taxel < taxel_count; ++taxel) {
    static_cast<void>(cells.next(cell));
    if (!parse_number(cell, frame.counts[taxel])) return count_error(taxel, cell);
  }
  return Done{};
}

Error FramesCsvReader::State::count_error(std::size_t taxel, std::string_view cell) const {
  const std::string place = "column " + taxel_name(taxel / cols, taxel % cols);
  const std::string what = cell.empty() ? " is empty" : ": " + in_quotes(cell) + " is not a number";
  return csv.error(place + what + "; write nan where a reading is missing");
}

FramesCsvReader::FramesCsvReader(std::unique_ptr<State> state) : state_(std::move(state)) {}

FramesCsvReader::~FramesCsvReader() = default;

Result<std::unique_ptr<FramesCsvReader>> FramesCsvReader::open(const std::string& path, std::size_t rows,
                                                               std::size_t cols) {
  Result<std::unique_ptr<std::istream>> in = open_input(path);
  if (!in) return in.error();
  return open(*std::move(in), path, rows, cols);
}

Result<std::unique_ptr<FramesCsvReader>> FramesCsvReader::open(std::unique_ptr<std::istream> in,
                                                               const std::string& name, std::size_t rows,
                                                               std::size_t cols) {
  assert(rows > 0 && cols > 0);
  std::istream& stream = *in;
  auto state = std::make_unique<State>(State{std::move(in), CsvReader(stream, name), rows, cols, {}});
  if (const Status header = state->read_header(); !header) return header.error();
  return std::unique_ptr<FramesCsvReader>(new FramesCsvReader(std::move(state)));
}

Result<bool> FramesCsvReader::next(RawFrame& frame) {
  std::string_view line;
  Result<bool> got_line = state_->csv.next_line(line);
  if (!got_line || !*got_line) return got_line;
  if (const Status read = state_->read_frame(line, frame); !read) return read.error();
  return true;
}

std::size_t FramesCsvReader::line() const noexcept {
  return state_->csv.line_number();
}

Result<std::vector<RawFrame>> read_frames(const std::string& path, std::size_t rows, std::size_t cols) {
  const Result<std::unique_ptr<FramesCsvReader>> reader = FramesCsvReader::open(path, rows, cols);
  if (!reader) return reader.error();
  std::vector<RawFrame> frames;
  while (true) {
    RawFrame frame;
    const Result<bool> got_frame = (*reader)->next(frame);
    if (!got_frame) return got_frame.error();
    if (!*got_frame) return frames;
    frames.push_back(std::move(frame));
  }
}

FramesCsvWriter::FramesCsvWriter(AtomicFile file, std::size_t taxel_count, const FramesCsvColumns& columns)
    : file_(std::move(file)), taxel_count_(taxel_count), columns_(columns) {}

Result<FramesCsvWriter> FramesCsvWriter::create(const std::string& path, std::size_t rows, std::size_t cols,
                                                const FramesCsvColumns& columns) {
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return file.error();
  std::string header = name_of(Column::time);
  if (columns.temperature_celsius) header.append(",").append(name_of(Column::temperature));
  if (columns.supply_v) header.append(",").append(name_of(Column::supply));
  append_taxel_names(header, rows, cols);
  file->write(header + "\n");
  return FramesCsvWriter(*std::move(file), rows * cols, columns);
}

Status FramesCsvWriter::write(const RawFrame& frame) {
  assert(frame.counts.size() == taxel_count_);
  line_.clear();
  append_seconds(line_, frame.time);
  const auto append_optional = [this](const std::optional<double>& value) {
    line_ += ',';
    if (value) append_number(line_, *value);
  };
  if (columns_.temperature_celsius) append_optional(frame.temperature_celsius);
  if (columns_.supply_v) append_optional(frame.supply_v);
  for (const float count : frame.counts) {
    line_ += ',';
    append_number(line_, count);
  }
  line_ += '\n';
  file_.write(line_);
  return file_.status();
}

Status FramesCsvWriter::commit() {
  return file_.commit();
}

}  // namespace dermis::store
