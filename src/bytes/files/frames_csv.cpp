// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/frames_csv.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "bytes/files/csv_reader.hpp"
#include "dermis/bytes/files/input.hpp"
#include "dermis/bytes/files/taxel_text.hpp"
#include "dermis/bytes/files/text.hpp"
#include "dermis/touch/frames/array_description.hpp"

namespace dermis::bytes::files {
namespace {

enum class Column { time, temperature, supply, sensor };

constexpr std::array<const char*, 3> kColumnNames{"time_s", "temperature_celsius", "supply_v"};
constexpr std::string_view kSensorBegin = "sensor";
constexpr std::string_view kSensorEnd = "_celsius";
constexpr std::size_t kMaxColumns = 2 * kMaxLines * kMaxLines + kColumnNames.size();  // with one sensor a taxel

const char* name_of(Column column) {
  return kColumnNames[static_cast<std::size_t>(column)];
}

/// "sensor0_celsius"
std::string sensor_name(std::size_t sensor) {
  return std::string(kSensorBegin).append(std::to_string(sensor)).append(kSensorEnd);
}

std::optional<Column> column_named(std::string_view name) {
  if (name.starts_with(kSensorBegin) && name.ends_with(kSensorEnd)) return Column::sensor;
  const auto* const found = std::find(kColumnNames.begin(), kColumnNames.end(), name);
  if (found == kColumnNames.end()) return std::nullopt;
  return static_cast<Column>(found - kColumnNames.begin());
}

using Cells = std::vector<std::string_view>;

/// The expected taxels of a header: the array's shape, or the one that its last column names.
struct Expected {
  FrameShape shape;
  const char* authority;
};

bool are_taxels_in_order(const Cells& cells, std::size_t first, FrameShape shape) {
  if (cells.size() - first != shape.taxel_count()) return false;
  for (std::size_t i = 0; i < shape.taxel_count(); ++i) {
    if (cells[first + i] != taxel_name(i / shape.cols, i % shape.cols)) return false;
  }
  return true;
}

/// Why the cells from `first` on are not the taxels of the array.
std::string taxel_mistake(const Cells& cells, std::size_t first, const Expected& expected) {
  const FrameShape shape = expected.shape;
  const std::string claim = std::string(expected.authority) + " " + size_text(shape);
  if (const std::optional<TaxelPlace> last = parse_taxel(cells.back())) {
    const bool is_grid = last->row < cells.size() && last->col < cells.size();
    const FrameShape other{last->row + 1, last->col + 1};
    if (is_grid && other != shape && are_taxels_in_order(cells, first, other)) {
      return "has " + size_text(other) + " taxels, " + claim;
    }
  }
  for (std::size_t i = 0; i < shape.taxel_count(); ++i) {
    const std::string name = taxel_name(i / shape.cols, i % shape.cols);
    const std::string_view cell = first + i < cells.size() ? cells[first + i] : "";
    if (cell == name) continue;
    if (!cell.empty() && !parse_taxel(cell) && !column_named(cell)) {
      return "unknown column " + in_quotes(cell) + "; expected " + name;
    }
    const bool is_absent = std::find(cells.begin(), cells.end(), name) == cells.end();
    if (is_absent) return std::string("column ").append(name).append(" is missing; ").append(claim);
    return "column " + in_quotes(cell) + " stands where " + name +
           " is expected; write the taxels row by row, after all other columns";
  }
  return "unknown column " + in_quotes(cells[first + shape.taxel_count()]) + " after the last taxel of a " +
         size_text(shape) + " array; remove it";
}

/// The shape of which the last column is the last taxel.
Result<Expected> learn_shape(const Cells& cells) {
  const std::optional<TaxelPlace> last = parse_taxel(cells.back());
  if (!last) {
    return bad_input("its last column is " + in_quotes(cells.back()) + ", not a taxel; the header ends with r0c0,...");
  }
  if (last->row >= kMaxLines || last->col >= kMaxLines) {
    return bad_input("its last column is " + in_quotes(cells.back()) + "; at most 1024x1024 taxels can be read");
  }
  return Expected{{last->row + 1, last->col + 1}, "its last column says"};
}

/// What a table holds that dermis writes beside the frames, by its first columns; empty of any other.
std::string_view other_content(const Cells& cells) {
  const auto begins = [&](std::initializer_list<std::string_view> names) {
    return cells.size() >= names.size() && std::equal(names.begin(), names.end(), cells.begin());
  };
  if (begins({"frame", "kind"})) return "loads";
  if (begins({"time_s", "id", "phase"})) return "contacts";
  if (begins({"time_s", "status", "total_n"})) return "total forces";
  if (begins({"time_s", "status"})) return "forces";
  return "";
}

/// The columns before the taxels, or what is wrong with the header.
Result<std::vector<Column>> parse_columns(const Cells& cells) {
  if (const std::string_view other = other_content(cells); !other.empty()) {
    return bad_input("is a table of " + std::string(other) + ", not of raw counts");
  }
  std::vector<Column> columns;
  std::size_t sensors = 0;
  for (const std::string_view cell : cells) {
    const std::optional<Column> column = column_named(cell);
    if (!column) break;
    if (*column == Column::sensor) {
      if (const std::string name = sensor_name(sensors++); cell != name) {
        return bad_input("column " + in_quotes(cell) + " stands where " + name + " is expected");
      }
    } else if (std::find(columns.begin(), columns.end(), *column) != columns.end()) {
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
                     "; before r0c0 stand time_s, temperature_celsius, sensor0_celsius and so on, and supply_v");
  }
  return columns;
}

struct Header {
  std::vector<Column> columns;  ///< Before the taxels.
  FrameShape shape;
  std::size_t sensors = 0;
};

Result<Header> parse_header(const Cells& cells, std::optional<FrameShape> shape) {
  Result<std::vector<Column>> columns = parse_columns(cells);
  if (!columns) return columns.error();
  const Result<Expected> expected = shape ? Expected{*shape, "the array is"} : learn_shape(cells);
  if (!expected) return expected.error();
  if (!are_taxels_in_order(cells, columns->size(), expected->shape)) {
    return bad_input(taxel_mistake(cells, columns->size(), *expected));
  }
  const auto sensors = static_cast<std::size_t>(std::count(columns->begin(), columns->end(), Column::sensor));
  if (sensors > kMaxLines && sensors != expected->shape.taxel_count()) {
    return bad_input("has " + std::to_string(sensors) +
                     " sensors of temperature; at most 1024, or one a taxel, can be read");
  }
  return Header{*std::move(columns), expected->shape, sensors};
}

}  // namespace

struct FramesCsvReader::State {
  std::unique_ptr<std::istream> in;
  CsvReader csv;
  Header header;
  Notice notice;
  std::size_t frames = 0;

  Status read_header(std::optional<FrameShape> shape);
  std::optional<Error> read_value(Column column, std::string_view cell, RawFrame& frame) const;
  std::optional<Error> read_sensor(std::string_view cell, RawFrame& frame) const;
  Status read_frame(std::string_view line, RawFrame& frame) const;
  Error count_error(std::size_t taxel, std::string_view cell) const;
};

Status FramesCsvReader::State::read_header(std::optional<FrameShape> shape) {
  std::string_view line;
  const Result<bool> got_line = csv.next_line(line);
  if (!got_line) return got_line.error();
  if (!*got_line) return csv.error("is empty; expected a header time_s,r0c0,...");
  if (count_cells(line) > kMaxColumns) {
    return csv.error("has " + std::to_string(count_cells(line)) + " columns; at most 1024x1024 taxels can be read");
  }
  Result<Header> parsed = parse_header(split_cells(line), shape);
  if (!parsed) return csv.error(parsed.error().message);
  header = *std::move(parsed);
  return Done{};
}

std::optional<Error> FramesCsvReader::State::read_value(Column column, std::string_view cell, RawFrame& frame) const {
  if (column == Column::time) {
    if (parse_seconds(cell, frame.time)) return std::nullopt;
    return csv.error("column time_s: " + in_quotes(cell) + " is not a time; write seconds of at most 9e9");
  }
  if (column == Column::sensor) return read_sensor(cell, frame);
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

/// An empty cell is a sensor without a reading.
std::optional<Error> FramesCsvReader::State::read_sensor(std::string_view cell, RawFrame& frame) const {
  float& celsius = frame.sensor_celsius.emplace_back(std::numeric_limits<float>::quiet_NaN());
  if (cell.empty() || parse_number(cell, celsius)) return std::nullopt;
  return csv.error("column " + sensor_name(frame.sensor_celsius.size() - 1) + ": " + in_quotes(cell) +
                   " is not a number; leave the cell empty where there is no value");
}

Status FramesCsvReader::State::read_frame(std::string_view line, RawFrame& frame) const {
  const std::size_t taxel_count = header.shape.taxel_count();
  const std::size_t header_size = header.columns.size() + taxel_count;
  if (const Status right = check_count(line, header_size); !right) return csv.error(right.error().message);
  frame.temperature_celsius.reset();
  frame.sensor_celsius.clear();
  frame.supply_v.reset();
  frame.counts.resize(taxel_count);
  CsvCells cells(line);
  std::string_view cell;
  for (const Column column : header.columns) {
    static_cast<void>(cells.next(cell));
    if (std::optional<Error> mistake = read_value(column, cell, frame)) return *std::move(mistake);
  }
  for (std::size_t taxel = 0; taxel < taxel_count; ++taxel) {
    static_cast<void>(cells.next(cell));
    if (cell.empty()) {
      frame.counts[taxel] = std::numeric_limits<float>::quiet_NaN();
    } else if (!parse_number(cell, frame.counts[taxel])) {
      return count_error(taxel, cell);
    }
  }
  return Done{};
}

Error FramesCsvReader::State::count_error(std::size_t taxel, std::string_view cell) const {
  const std::string place = "column " + taxel_name(taxel / header.shape.cols, taxel % header.shape.cols);
  return csv.error(place + ": " + in_quotes(cell) +
                   " is not a number; leave the cell empty where a reading is missing");
}

FramesCsvReader::FramesCsvReader(std::unique_ptr<State> state) : state_(std::move(state)) {}

FramesCsvReader::~FramesCsvReader() = default;

Result<std::unique_ptr<FramesCsvReader>> FramesCsvReader::open(const std::string& path, std::optional<FrameShape> shape,
                                                               Notice notice) {
  Result<std::unique_ptr<std::istream>> in = open_input(path);
  if (!in) return in.error();
  return open(*std::move(in), path, shape, std::move(notice));
}

Result<std::unique_ptr<FramesCsvReader>> FramesCsvReader::open(std::unique_ptr<std::istream> in,
                                                               const std::string& name, std::optional<FrameShape> shape,
                                                               Notice notice) {
  assert(!shape || shape->taxel_count() > 0);
  std::istream& stream = *in;
  auto state = std::make_unique<State>(State{std::move(in), CsvReader(stream, name), {}, std::move(notice)});
  if (const Status header = state->read_header(shape); !header) return header.error();
  return std::unique_ptr<FramesCsvReader>(new FramesCsvReader(std::move(state)));
}

Result<bool> FramesCsvReader::next(RawFrame& frame) {
  std::string_view line;
  Result<bool> got_line = state_->csv.next_line(line);
  if (!got_line || !*got_line) return got_line;
  frame.acquisition = {};
  const Status read = state_->read_frame(line, frame);
  if (!read && state_->csv.was_cut() && state_->frames > 0) {
    if (state_->notice) state_->notice(place() + ": is cut off; the frames before are read");
    return false;
  }
  if (!read) return read.error();
  ++state_->frames;
  return true;
}

std::optional<FrameShape> FramesCsvReader::shape() const {
  return state_->header.shape;
}

std::string FramesCsvReader::place() const {
  return state_->csv.place();
}

FramesCsvWriter::FramesCsvWriter(AtomicFile file, FrameShape shape, const FramesCsvColumns& columns)
    : file_(std::move(file)), shape_(shape), columns_(columns) {}

Result<std::unique_ptr<FramesCsvWriter>> FramesCsvWriter::create(const std::string& path, FrameShape shape,
                                                                 const FramesCsvColumns& columns) {
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return file.error();
  return std::unique_ptr<FramesCsvWriter>(new FramesCsvWriter(*std::move(file), shape, columns));
}

/// Puts the header into the line. It is written with the first frame, so that the reader of a pipe gets both at once.
void FramesCsvWriter::begin(std::size_t sensors) {
  line_ = name_of(Column::time);
  if (columns_.temperature_celsius) line_.append(",").append(name_of(Column::temperature));
  for (std::size_t sensor = 0; sensor < sensors; ++sensor) line_.append(",").append(sensor_name(sensor));
  if (columns_.supply_v) line_.append(",").append(name_of(Column::supply));
  append_taxel_names(line_, shape_.rows, shape_.cols);
  line_ += '\n';
  sensors_ = sensors;
}

Status FramesCsvWriter::write(const RawFrame& frame) {
  assert(frame.counts.size() == shape_.taxel_count());
  line_.clear();
  if (!sensors_) begin(std::max(columns_.sensors, frame.sensor_celsius.size()));
  append_seconds(line_, frame.time);
  const auto append_optional = [this](const std::optional<double>& value) {
    line_ += ',';
    if (value) append_number(line_, *value);
  };
  if (columns_.temperature_celsius) append_optional(frame.temperature_celsius);
  for (std::size_t sensor = 0; sensor < *sensors_; ++sensor) {
    const bool has_reading = sensor < frame.sensor_celsius.size() && !std::isnan(frame.sensor_celsius[sensor]);
    line_ += ',';
    if (has_reading) append_number(line_, frame.sensor_celsius[sensor]);
  }
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
  if (!sensors_) {
    begin(columns_.sensors);
    file_.write(line_);
  }
  return file_.commit();
}

}  // namespace dermis::bytes::files
