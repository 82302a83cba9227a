// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "learn/calibration/circuit_fit/estimate.hpp"
#include "learn/calibration/circuit_fit/normal_equations.hpp"
#include "learn/calibration/circuit_fit/rubber.hpp"

namespace dermis::learn::calibration {

/// A pressed taxel of one frame.
struct PressedReading {
  std::size_t taxel = 0;
  double log_force = 0.0;  ///< Scaled.
  double temperature = 0.0;
  double siemens = 0.0;
  double sigma_siemens = 0.0;
  Eigen::VectorXd slope;  ///< d siemens / d parameter.
};

/// A pressed reading against its law.
struct PressedPoint {
  bool usable = false;             ///< Large enough over the noise to take its logarithm.
  double excess = 0.0;             ///< Over the unloaded conductance, over the reference conductance.
  double expected = 0.0;           ///< Excess by the law; the reading's own where there is none.
  double logarithm = 0.0;          ///< Of it, without bias.
  double relative_variance = 0.0;  ///< From the noise of the readings.
  double residual = 0.0;           ///< From the law.
  Eigen::VectorXd basis;
  Eigen::VectorXd common;
};

[[nodiscard]] PressedPoint pressed_point(const PressedReading& reading, const Rubber& rubber, const Scatter& scatter);

/// Columns: parameters, common terms of the taxels' laws, ln(g - u). `idle`: how the unloaded laws follow the
/// parameters.
[[nodiscard]] NormalEquations pressed_equations(const std::vector<PressedReading>& readings, const Elimination& idle,
                                                const Rubber& rubber, const Scatter& scatter);

}  // namespace dermis::learn::calibration
