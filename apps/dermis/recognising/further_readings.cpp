// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "recognising/further_readings.hpp"

#include <fmt/core.h>

#include <cmath>
#include <limits>

#include "dermis/bytes/files/csv_table.hpp"
#include "dermis/bytes/files/text.hpp"
#include "dermis/learn/recognition/segment.hpp"

namespace dermis::recognising {
namespace {

using bytes::files::CsvTable;

constexpr float kMissing = std::numeric_limits<float>::quiet_NaN();

Result<Nanos> time_at(const CsvTable& table, std::size_t row, std::size_t column) {
  Nanos time{};
  if (bytes::files::parse_seconds(table.at(row, column), time)) return time;
  return table.error(row, "time_s " + bytes::files::in_quotes(table.at(row, column)) + " is not a time in seconds");
}

Result<float> reading_at(const CsvTable& table, std::size_t row, std::size_t column) {
  const std::string& cell = table.at(row, column);
  float value = kMissing;
  if (!cell.empty() && !bytes::files::parse_number(cell, value)) {
    return table.error(row, table.columns()[column] + " " + bytes::files::in_quotes(cell) + " is not a number");
  }
  return std::isfinite(value) ? value : kMissing;
}

/// Places of the columns that are readings.
std::vector<std::size_t> readings_of(const CsvTable& table) {
  std::vector<std::size_t> places;
  for (std::size_t column = 0; column < table.columns().size(); ++column) {
    if (table.columns()[column] != "time_s" && table.columns()[column] != "recording") places.push_back(column);
  }
  return places;
}

}  // namespace

Result<FurtherReadings> FurtherReadings::read(const std::string& path, const std::string& recording) {
  const Result<CsvTable> table = CsvTable::read(path);
  if (!table) return table.error();
  const Result<std::size_t> time_column = table->needed_column("time_s");
  if (!time_column) return time_column.error();
  const std::vector<std::size_t> columns = readings_of(*table);
  if (columns.empty()) return table->error("has no reading beside time_s; a column each is expected");
  const std::optional<std::size_t> recording_column = table->column("recording");
  FurtherReadings readings;
  readings.path_ = path;
  readings.recording_ = recording;
  for (const std::size_t column : columns) readings.names_.push_back(table->columns()[column]);
  for (std::size_t row = 0; row < table->rows(); ++row) {
    if (recording_column && table->at(row, *recording_column) != recording) continue;
    const Result<Nanos> time = time_at(*table, row, *time_column);
    if (!time) return time.error();
    if (!readings.times_.empty() && *time < readings.times_.back()) {
      return table->error(row, "time_s goes back; sort the lines by their time");
    }
    readings.times_.push_back(*time);
    for (const std::size_t column : columns) {
      const Result<float> value = reading_at(*table, row, column);
      if (!value) return value.error();
      readings.lines_.push_back(*value);
    }
  }
  if (readings.times_.empty()) return table->error("has no line for " + bytes::files::in_quotes(recording));
  readings.last_.assign(columns.size(), kMissing);
  readings.last_times_.assign(columns.size(), Nanos{});
  readings.values_.assign(columns.size(), kMissing);
  return readings;
}

void FurtherReadings::move_to(Nanos time) {
  for (; next_ < times_.size() && times_[next_] <= time; ++next_) {
    for (std::size_t i = 0; i < names_.size(); ++i) {
      const float value = lines_[next_ * names_.size() + i];
      if (std::isnan(value)) continue;
      last_[i] = value;
      last_times_[i] = times_[next_];
    }
  }
  bool is_complete = true;
  for (std::size_t i = 0; i < names_.size(); ++i) {
    values_[i] = last_times_[i] >= time - learn::recognition::kLongestSilence ? last_[i] : kMissing;
    is_complete = is_complete && !std::isnan(values_[i]);
  }
  ++frames_;
  frames_with_missing_ += is_complete ? 0 : 1;
}

std::optional<std::string> FurtherReadings::describe_missing() const {
  if (frames_with_missing_ == 0) return std::nullopt;
  return fmt::format(
      "{}: {} of {} frames of {} lack a reading of the half second before them; what is missing counts as the mean",
      path_, frames_with_missing_, frames_, recording_);
}

}  // namespace dermis::recognising
