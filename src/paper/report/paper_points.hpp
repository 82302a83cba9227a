// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "dermis/paper/paper_report.hpp"

namespace dermis::paper {

/// The points of one of the paper's three forces.
struct PaperLevel {
  double newtons = 0.0;
  std::size_t paper_figure = 0;  ///< 11, 12, 13
  std::vector<PaperPoint> points;
};

/// 10, 20 and 50 N.
[[nodiscard]] std::array<PaperLevel, 3> paper_levels(const PaperReproduction& reproduction);

/// Estimate over truth less 1; not finite where the estimator gives no force.
[[nodiscard]] double bank_error(const PaperPoint& point);
[[nodiscard]] double dermis_error(const PaperPoint& point);
/// Output voltage over that of the calibration less 1.
[[nodiscard]] double voltage_error(const PaperPoint& point);

using PointError = double (*)(const PaperPoint&);

/// Largest magnitude; infinite where a point has none. At least one point.
[[nodiscard]] double worst_error(const std::vector<PaperPoint>& points, PointError error);

/// How many are within the 5 % of the paper.
[[nodiscard]] std::size_t count_within(const std::vector<PaperPoint>& points, PointError error);

/// Mean of the finite values of a field, or NaN.
[[nodiscard]] double mean_of(const std::vector<PaperPoint>& points, double PaperPoint::*field);

/// "10 N: 1.23 %, 20 N: 4.56 %, ..." for the levels that have points.
[[nodiscard]] std::string worst_by_level(const PaperReproduction& reproduction, PointError error);

}  // namespace dermis::paper
