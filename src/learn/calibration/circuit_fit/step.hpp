// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <Eigen/Core>
#include <vector>

#include "learn/calibration/circuit_fit/assumptions.hpp"
#include "learn/calibration/circuit_fit/line_parameters.hpp"
#include "learn/calibration/circuit_fit/normal_equations.hpp"

namespace dermis::learn::calibration {

/// A step of the parameters, then of the common terms of the pressed laws (Rubber::sheet).
struct Step {
  Eigen::VectorXd solution;
  Eigen::MatrixXd covariance;
  Eigen::Index parameters = 0;

  [[nodiscard]] Eigen::VectorXd of_parameters() const { return solution.head(parameters); }
  [[nodiscard]] Eigen::VectorXd sheet() const { return solution.tail(solution.size() - parameters); }

  /// Goes only a share of the way in the parameters.
  void shorten(double share) { solution.head(parameters) *= share; }

  /// The largest step of a parameter, in its standard errors.
  [[nodiscard]] double largest() const;
};

/// Solves the normal equations of all readings and assumptions, the taxels' laws eliminated.
[[nodiscard]] Step solve_step(const LineParameters& lines, const Elimination& idle, const Elimination& pressed,
                              const std::vector<Assumption>& assumptions);

/// The residual of the equations at the present parameters, with the best laws.
[[nodiscard]] double cost_without_step(const LineParameters& lines, const Elimination& idle, const Elimination& pressed,
                                       const std::vector<Assumption>& assumptions);

}  // namespace dermis::learn::calibration
