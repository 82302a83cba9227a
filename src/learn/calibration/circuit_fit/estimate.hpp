// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <Eigen/Core>

#include "learn/calibration/circuit_fit/rubber.hpp"

namespace dermis::learn::calibration {

inline constexpr double kLineSpread = 0.1;      // resistances of one kind are alike: first guess of their spread
inline constexpr double kShapeSpread = 0.1;     // first guess of the scatter of the laws' shapes over the taxels
inline constexpr double kRubberScatter = 0.01;  // first guess

/// The scatter of values that are alike, learned from the readings.
struct Scatter {
  double noise_variance = 1.0;  ///< Variance of the idle readings over the nominal variance of their noise.
  double rubber_variance = kRubberScatter * kRubberScatter;  ///< Relative variance of a pressed taxel about its law.
  Eigen::VectorXd shape_variance = Eigen::VectorXd::Constant(kShapeTerms, kShapeSpread* kShapeSpread);
  double drive_spread = kLineSpread;  ///< Relative.
  double load_spread = kLineSpread;
  double sheet = 0.0;  ///< Unloaded conductance from line to line, relative; 0: never compared.
};

/// The state of the fit at one time; a step gives the next.
struct Estimate {
  Eigen::VectorXd parameters;  ///< See LineParameters.
  Rubber rubber;
  Scatter scatter;
};

}  // namespace dermis::learn::calibration
