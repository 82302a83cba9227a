// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <Eigen/Core>
#include <vector>

#include "learn/calibration/circuit_fit/line_parameters.hpp"

namespace dermis::learn::calibration {

/// Relative standard errors of the resistances, 1 at most; 0: given.
struct StandardErrors {
  std::vector<double> drive;
  std::vector<double> load;
  std::vector<double> drive_ohm;  ///< Errors of the drivers, not relative [ohm]; empty: all are given.
  double common_drive = 0.0;      ///< Of the drivers' mean.
  double correlation = 0.0;       ///< Share of the variance that all drivers share.
};

/// `covariance` is of the parameters, and may be of more after them.
[[nodiscard]] StandardErrors standard_errors(const LineParameters& lines, const Eigen::VectorXd& parameters,
                                             const Eigen::MatrixXd& covariance);

}  // namespace dermis::learn::calibration
