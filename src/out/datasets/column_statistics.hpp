// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "dermis/out/datasets/episode_sink.hpp"

namespace dermis::out::datasets {

/// Lowest, highest, mean and standard deviation of each element of a column, over its steps. Values that are not finite
/// do not count. Not thread-safe.
class ColumnStatistics {
 public:
  explicit ColumnStatistics(const Column& column);

  /// Rows of the column.
  void add(std::span<const std::byte> values);
  /// Other rows of it.
  void add(const ColumnStatistics& others);
  [[nodiscard]] std::size_t elements() const noexcept { return first_.size(); }

  /// Those of element `k`; 0 where no value counts.
  [[nodiscard]] double lowest(std::size_t k) const;
  [[nodiscard]] double highest(std::size_t k) const;
  [[nodiscard]] double mean(std::size_t k) const;
  [[nodiscard]] double deviation(std::size_t k) const;  ///< Of the population.

 private:
  template <typename T>
  void add_rows(std::span<const std::byte> values);

  ColumnType type_;
  bool is_first_ = true;
  // One of each element; sums are of the differences from the value of the first row.
  std::vector<double> first_;
  std::vector<double> sum_;
  std::vector<double> squares_;
  std::vector<double> count_;
  std::vector<double> lowest_;
  std::vector<double> highest_;
};

}  // namespace dermis::out::datasets
