// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/circuit_fit/pressed_readings.hpp"

#include <algorithm>
#include <cmath>

namespace dermis::learn::calibration {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kLeastPressSigmas = 5.0;  // a reading below is not to be taken the logarithm of

}  // namespace

PressedPoint pressed_point(const PressedReading& reading, const Rubber& rubber, const Scatter& scatter) {
  PressedPoint point;
  point.basis = pressed_basis(reading.log_force, reading.temperature);
  point.excess = reading.siemens / rubber.reference_siemens;
  const TaxelLaw& law = rubber.laws[reading.taxel];
  if (law.unloaded.size() > 0) point.excess -= law.unloaded.dot(unloaded_basis(rubber, reading.temperature));
  const double sigma = reading.sigma_siemens / rubber.reference_siemens;
  const bool has_law = law.pressed.size() > 0;
  point.common = common_basis(reading.log_force, reading.temperature, point.excess);
  const double expected_logarithm =
      has_law ? law.pressed.dot(point.basis) + rubber.sheet.tail(kCommonTerms).dot(point.common) : 0.0;
  // The variance from the law, not from the reading: weights must not follow the noise.
  point.expected = has_law ? std::exp(expected_logarithm) : point.excess;
  point.usable = std::min(point.expected, point.excess) > kLeastPressSigmas * sigma;
  if (!point.usable) return point;
  point.relative_variance = scatter.noise_variance * std::pow(sigma / point.expected, 2);
  point.logarithm = std::log(point.excess) + 0.5 * point.relative_variance;
  point.residual = point.logarithm - expected_logarithm;
  return point;
}

NormalEquations pressed_equations(const std::vector<PressedReading>& readings, const Elimination& idle,
                                  const Rubber& rubber, const Scatter& scatter) {
  const Index slopes = idle.normal.cols() - 1;
  NormalEquations equations(rubber.laws.size(), kPressedTerms, slopes + kSheetTerms + 1);
  VectorXd row(slopes + kSheetTerms + 1);
  for (const PressedReading& reading : readings) {
    const PressedPoint point = pressed_point(reading, rubber, scatter);
    if (!point.usable) continue;
    VectorXd slope = reading.slope / rubber.reference_siemens;
    const Eigen::MatrixXd& idle_law = idle.laws[reading.taxel];
    if (idle_law.size() > 0) {
      slope -= idle_law.leftCols(slopes).transpose() * unloaded_basis(rubber, reading.temperature);
    }
    row << slope / point.excess, -point.basis.tail(kShapeTerms), -point.common, point.logarithm;
    const double weight = 1.0 / (point.relative_variance + scatter.rubber_variance);
    equations.add_local(reading.taxel, point.basis, row, weight);
    equations.global.selfadjointView<Eigen::Lower>().rankUpdate(row, weight);
  }
  return equations;
}

}  // namespace dermis::learn::calibration
