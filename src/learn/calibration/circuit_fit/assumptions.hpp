// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "learn/calibration/circuit_fit/estimate.hpp"
#include "learn/calibration/circuit_fit/line_parameters.hpp"
#include "learn/calibration/circuit_fit/normal_equations.hpp"

namespace dermis::learn::calibration {

/// A likely value as a pseudo-observation: `row . step + value = 0` with the standard deviation sigma.
struct Assumption {
  Eigen::VectorXd row;  ///< [parameters]
  double value = 0.0;
  double sigma = 1.0;
};

/// Resistances of one kind are alike: each lies about their mean with a spread that is learned.
[[nodiscard]] std::vector<Assumption> alike_lines(const LineParameters& lines, const Estimate& estimate);

/// The scale is that of the nominal load where no resistance is given: only ratios exist then.
[[nodiscard]] std::vector<Assumption> nominal_scale(const LineParameters& lines, const Eigen::VectorXd& parameters);

/// How the unloaded rubber differs from line to line.
struct SheetComparison {
  double scatter = 0.0;  ///< Between the means of driven lines, relative.
  std::vector<Assumption> assumptions;
};

/// Assumes that the rubber differs no more from sensed line to sensed line than from driven line to driven line, where
/// that is measured. Any further difference of the unloaded conductances is due to the loads. Empty: no loads are
/// unknown, or there are too few taxels to compare the lines.
[[nodiscard]] std::optional<SheetComparison> compare_sheet(const LineParameters& lines, const Elimination& idle);

}  // namespace dermis::learn::calibration
