// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/datasets/column_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace dermis::out::datasets {

ColumnStatistics::ColumnStatistics(const Column& column)
    : type_(column.type),
      first_(column.elements()),
      sum_(first_),
      squares_(first_),
      count_(first_),
      lowest_(first_.size(), std::numeric_limits<double>::infinity()),
      highest_(first_.size(), -std::numeric_limits<double>::infinity()) {}

template <typename T>
void ColumnStatistics::add_rows(std::span<const std::byte> values) {
  const std::size_t elements = first_.size();
  const std::size_t row_bytes = elements * sizeof(T);
  std::vector<T> row(elements);
  for (; !values.empty(); values = values.subspan(row_bytes)) {
    std::memcpy(row.data(), values.data(), row_bytes);
    if (is_first_) {
      for (std::size_t k = 0; k < elements; ++k) {
        const auto value = static_cast<double>(row[k]);
        first_[k] = std::isfinite(value) ? value : 0.0;
      }
      is_first_ = false;
    }
    for (std::size_t k = 0; k < elements; ++k) {
      const auto value = static_cast<double>(row[k]);
      const bool counts = std::abs(value) <= std::numeric_limits<double>::max();
      const double difference = counts ? value - first_[k] : 0.0;
      sum_[k] += difference;
      squares_[k] += difference * difference;
      count_[k] += counts ? 1.0 : 0.0;
      lowest_[k] = counts && value < lowest_[k] ? value : lowest_[k];
      highest_[k] = counts && value > highest_[k] ? value : highest_[k];
    }
  }
}

void ColumnStatistics::add(std::span<const std::byte> values) {
  switch (type_) {
    case ColumnType::float32: return add_rows<float>(values);
    case ColumnType::int64: return add_rows<std::int64_t>(values);
    case ColumnType::boolean: return add_rows<std::uint8_t>(values);
  }
}

void ColumnStatistics::add(const ColumnStatistics& others) {
  if (is_first_) {
    *this = others;
    return;
  }
  for (std::size_t k = 0; k < elements(); ++k) {
    const double shift = others.first_[k] - first_[k];
    squares_[k] += others.squares_[k] + shift * (2.0 * others.sum_[k] + others.count_[k] * shift);
    sum_[k] += others.sum_[k] + others.count_[k] * shift;
    count_[k] += others.count_[k];
    lowest_[k] = std::min(lowest_[k], others.lowest_[k]);
    highest_[k] = std::max(highest_[k], others.highest_[k]);
  }
}

double ColumnStatistics::lowest(std::size_t k) const {
  return count_[k] > 0.0 ? lowest_[k] : 0.0;
}

double ColumnStatistics::highest(std::size_t k) const {
  return count_[k] > 0.0 ? highest_[k] : 0.0;
}

double ColumnStatistics::mean(std::size_t k) const {
  return count_[k] > 0.0 ? first_[k] + sum_[k] / count_[k] : 0.0;
}

double ColumnStatistics::deviation(std::size_t k) const {
  if (count_[k] <= 0.0) return 0.0;
  const double mean = sum_[k] / count_[k];
  return std::sqrt(std::max(0.0, squares_[k] / count_[k] - mean * mean));
}

}  // namespace dermis::out::datasets
