// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "datasets/sampled_series.hpp"

#include <algorithm>
#include <iterator>
#include <optional>

#include "dermis/files/csv_table.hpp"
#include "dermis/files/text.hpp"

namespace dermis::datasets {

Result<SampledSeries> SampledSeries::read(const std::string& path) {
  const Result<files::CsvTable> table = files::CsvTable::read(path);
  if (!table) return table.error();
  const Result<std::size_t> time_column = table->needed_column("time_s");
  if (!time_column) return time_column.error();
  SampledSeries series;
  for (std::size_t column = 0; column < table->columns().size(); ++column) {
    if (column != *time_column) series.names_.push_back(table->columns()[column]);
  }
  if (table->rows() == 0 || series.names_.empty()) return table->error("has no numbers beside time_s");
  for (std::size_t row = 0; row < table->rows(); ++row) {
    Nanos time{};
    if (!files::parse_seconds(table->at(row, *time_column), time)) return table->error(row, "time_s is no time");
    if (!series.times_.empty() && time < series.times_.back()) return table->error(row, "time_s goes back");
    std::vector<float> numbers;
    for (std::size_t column = 0; column < table->columns().size(); ++column) {
      if (column == *time_column) continue;
      const Result<double> number = table->number_at(row, column);
      if (!number) return number.error();
      numbers.push_back(static_cast<float>(*number));
    }
    series.times_.push_back(time);
    series.rows_.push_back(std::move(numbers));
  }
  return series;
}

const std::vector<float>& SampledSeries::at(Nanos time) const {
  const auto after = std::upper_bound(times_.begin(), times_.end(), time);
  return rows_[after == times_.begin() ? 0 : static_cast<std::size_t>(after - times_.begin() - 1)];
}

}  // namespace dermis::datasets
