// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/circuit_fit/step.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "learn/calibration/circuit_fit/rubber.hpp"

namespace dermis::learn::calibration {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// The idle readings' equations do not know the shapes of the pressed laws.
void add_idle(const Elimination& idle, Index parameters, MatrixXd& normal) {
  normal.topLeftCorner(parameters, parameters) += idle.normal.topLeftCorner(parameters, parameters);
  normal.col(parameters + kSheetTerms).head(parameters) += idle.normal.col(parameters).head(parameters);
}

void add(const Assumption& assumption, Index parameters, MatrixXd& normal) {
  const auto& [row, value, sigma] = assumption;
  normal.topLeftCorner(parameters, parameters) += row * row.transpose() / (sigma * sigma);
  normal.col(parameters + kSheetTerms).head(parameters) += row * value / (sigma * sigma);
}

}  // namespace

double Step::largest() const {
  double largest = 0.0;
  for (Index p = 0; p < parameters; ++p) {
    largest = std::max(largest, std::abs(solution[p]) / std::sqrt(covariance(p, p)));
  }
  return largest;
}

double cost_without_step(const LineParameters& lines, const Elimination& idle, const Elimination& pressed,
                         const std::vector<Assumption>& assumptions) {
  double cost = idle.cost() + pressed.cost();
  for (const Assumption& assumption : assumptions) cost += std::pow(assumption.value / assumption.sigma, 2);
  const MatrixXd shapes = pressed.normal.block(lines.count(), lines.count(), kSheetTerms, kSheetTerms) +
                          MatrixXd::Identity(kSheetTerms, kSheetTerms);
  const Eigen::VectorXd gradient = pressed.normal.col(lines.count() + kSheetTerms).segment(lines.count(), kSheetTerms);
  return cost - gradient.dot(shapes.ldlt().solve(gradient));
}

Step solve_step(const LineParameters& lines, const Elimination& idle, const Elimination& pressed,
                const std::vector<Assumption>& assumptions) {
  const Index unknowns = lines.count() + kSheetTerms;
  MatrixXd normal = pressed.normal;
  add_idle(idle, lines.count(), normal);
  for (Index s = lines.count(); s < unknowns; ++s) normal(s, s) += 1.0;  // shapes of the order of 1 at most
  for (const Assumption& assumption : assumptions) add(assumption, lines.count(), normal);
  const Eigen::LDLT<MatrixXd> factors(normal.topLeftCorner(unknowns, unknowns));
  return {-factors.solve(normal.col(unknowns).head(unknowns)), factors.solve(MatrixXd::Identity(unknowns, unknowns)),
          lines.count()};
}

}  // namespace dermis::learn::calibration
