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
      highest_(first_.size(), -std::numeric_limits<double>::infinity()),
      quantiles_(column.kinds > 0 ? column.kinds : first_.size()) {
  if (type_ != ColumnType::int64) origin_ = 0.0;
}

void ColumnStatistics::clear() {
  is_first_ = true;
  for (std::vector<double>* const sums : {&sum_, &squares_, &count_}) std::fill(sums->begin(), sums->end(), 0.0);
  std::fill(lowest_.begin(), lowest_.end(), std::numeric_limits<double>::infinity());
  std::fill(highest_.begin(), highest_.end(), -std::numeric_limits<double>::infinity());
  std::fill(quantiles_.begin(), quantiles_.end(), Quantiles());
}

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
      if (!origin_) origin_ = first_.front();
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
    for (std::size_t k = 0; k < elements; ++k) {
      const auto value = static_cast<float>(static_cast<double>(row[k]) - *origin_);
      if (std::isfinite(value)) quantiles_[k % kinds()].add(value);
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
  for (std::size_t k = 0; k < kinds(); ++k) quantiles_[k].add(others.quantiles_[k]);
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

ColumnStatistics::OfKind ColumnStatistics::of_kind(std::size_t kind) const {
  OfKind of{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  double count = 0.0;
  for (std::size_t k = kind; k < elements(); k += kinds()) {
    if (count_[k] <= 0.0) continue;
    of.lowest = std::min(of.lowest, lowest_[k]);
    of.highest = std::max(of.highest, highest_[k]);
    of.mean += count_[k] * mean(k);
    count += count_[k];
  }
  if (count <= 0.0) return {.quantiles = std::vector<double>(kShares.size())};
  of.mean /= count;
  double squares = 0.0;
  for (std::size_t k = kind; k < elements(); k += kinds()) {
    const double shift = mean(k) - of.mean;
    squares += count_[k] * (deviation(k) * deviation(k) + shift * shift);
  }
  of.deviation = std::sqrt(squares / count);
  for (const double share : kShares) {
    of.quantiles.push_back(std::clamp(*origin_ + quantiles_[kind].at(share), of.lowest, of.highest));
  }
  return of;
}

}  // namespace dermis::out::datasets
