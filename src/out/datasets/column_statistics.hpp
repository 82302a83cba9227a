// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "dermis/out/datasets/episode_sink.hpp"
#include "out/datasets/quantiles.hpp"

namespace dermis::out::datasets {

/// Lowest, highest, mean and standard deviation of each element of a column, over its steps, and of each kind of its
/// elements, with quantiles. Values that are not finite do not count. Not thread-safe.
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

  /// Those of all elements of a kind; see Column::kinds.
  struct OfKind {
    double lowest = 0.0;
    double highest = 0.0;
    double mean = 0.0;
    double deviation = 0.0;
    std::vector<double> quantiles{};  ///< At kShares.
  };
  static constexpr std::array kShares = {0.01, 0.10, 0.50, 0.90, 0.99};
  [[nodiscard]] std::size_t kinds() const noexcept { return quantiles_.size(); }
  [[nodiscard]] OfKind of_kind(std::size_t kind) const;

  /// Forgets all rows.
  void clear();

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
  std::vector<Quantiles> quantiles_;  ///< One for each kind: differences from `origin_`.
  std::optional<double> origin_;      ///< 0, but for whole numbers: such as times, which have many digits.
};

}  // namespace dermis::out::datasets
