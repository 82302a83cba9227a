// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace dermis::learn::calibration {

/// A least-squares problem sum |y + D step - B law|^2 in which the laws of the taxels are eliminated. E = [D, y].
struct NormalEquations {
  Eigen::MatrixXd global;              ///< E^T E, its lower half.
  std::vector<Eigen::MatrixXd> local;  ///< Of every taxel: B^T [B, E].
  std::vector<double> readings;

  NormalEquations(std::size_t taxels, Eigen::Index law_terms, Eigen::Index columns);

  /// `row`: E; the global part is the caller's, who has many rows at once.
  void add_local(std::size_t taxel, const Eigen::VectorXd& basis, const Eigen::Ref<const Eigen::VectorXd>& row,
                 double weight);

  NormalEquations& operator+=(const NormalEquations& other);
  /// All weights times `factor`.
  NormalEquations& operator*=(double factor);
};

/// The laws that minimise, as linear functions of the step: law = [law_slope, law] (step, 1).
struct Elimination {
  Eigen::MatrixXd normal;  ///< For E, with the laws eliminated; its last row and column hold the gradient and the cost.
  std::vector<Eigen::MatrixXd> laws;        ///< For every taxel [terms, columns]; empty: no reading.
  std::vector<Eigen::MatrixXd> covariance;  ///< For every law at a fixed step [terms, terms].
  double readings = 0.0;
  double taxels = 0.0;

  /// The residual of the readings at no step.
  [[nodiscard]] double cost() const { return normal(normal.rows() - 1, normal.cols() - 1); }
};

/// `prior_precision` [terms, taxels] draws each term of a law to 0.
[[nodiscard]] Elimination eliminate_laws(const NormalEquations& equations, const Eigen::MatrixXd& prior_precision);

}  // namespace dermis::learn::calibration
