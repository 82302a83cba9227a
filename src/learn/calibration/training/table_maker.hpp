// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "dermis/learn/calibration/sample_temperatures.hpp"
#include "dermis/touch/fusion/force_tables.hpp"
#include "learn/calibration/tables/monotone_knots.hpp"
#include "learn/calibration/training/taxel_training.hpp"

namespace dermis::learn::calibration {

/// The table of one taxel.
struct TaxelTable {
  std::vector<Knot> knots;   ///< Newtons and siemens, both rising; none: there is no table.
  double per_celsius = 0.0;  ///< The linear temperature term.
};

/// Makes the tables of taxels from their known forces.
class TableMaker {
 public:
  explicit TableMaker(const SampleTemperatures& temperatures)
      : half_span_celsius_(temperatures.is_input ? temperatures.span.half_span_celsius : 0.0) {}

  [[nodiscard]] double temperature_offset(const TaxelPoint& point) const {
    return point.temperature * half_span_celsius_;
  }

  /// `points` by rising force.
  [[nodiscard]] TaxelTable fit(const std::vector<TaxelPoint>& points) const;

 private:
  double half_span_celsius_;
};

/// Tables with fewer knots than others begin with some on the line from zero to their first.
[[nodiscard]] touch::fusion::ForceTables assemble_tables(const std::vector<TaxelTable>& tables,
                                                         const std::vector<std::size_t>& taxels);

[[nodiscard]] std::vector<TaxelPoint> by_force(std::span<const TaxelPoint> points);

}  // namespace dermis::learn::calibration
