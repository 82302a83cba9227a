// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/circuit_fit/scatter.hpp"

#include <algorithm>
#include <cmath>

namespace dermis::learn::calibration {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kLeastNoiseVariance = 0.01;  // over the described noise: readings that are cut at 0 have none
constexpr double kLeastShapeSpread = 1e-4;
constexpr double kLeastRubberScatter = 1e-4;
constexpr double kMostRubberScatter = 1.0;

VectorXd with_one(const VectorXd& step) {
  VectorXd extended(step.size() + 1);
  extended << step, 1.0;
  return extended;
}

double learn_noise(const Elimination& idle, const Step& step, Index unloaded_terms, double noise_variance) {
  const double freedom = idle.readings - static_cast<double>(unloaded_terms) * idle.taxels;
  if (!(freedom > 0.0)) return noise_variance;
  const VectorXd extended = with_one(step.of_parameters());
  return std::max(noise_variance * (extended.dot(idle.normal * extended) / freedom), kLeastNoiseVariance);
}

/// The scatter of the readings about their laws beyond their noise: a Newton step of its likelihood.
double learn_rubber(const std::vector<PressedReading>& readings, double freedom_lost, const Rubber& rubber,
                    const Scatter& scatter) {
  double excess_variance = 0.0;
  double weight = 0.0;
  for (const PressedReading& reading : readings) {
    const PressedPoint point = pressed_point(reading, rubber, scatter);
    if (!point.usable) continue;
    const double total = point.relative_variance + scatter.rubber_variance;
    excess_variance += (freedom_lost * point.residual * point.residual - total) / (total * total);
    weight += 1.0 / (total * total);
  }
  if (weight == 0.0) return scatter.rubber_variance;
  return std::clamp(scatter.rubber_variance + excess_variance / weight, kLeastRubberScatter * kLeastRubberScatter,
                    kMostRubberScatter * kMostRubberScatter);
}

/// Scatter of the shapes over the taxels: MacKay's fixed point (Neural Computation 4, 1992).
VectorXd learn_shapes(const Elimination& pressed, const Step& step, const VectorXd& shape_variance) {
  constexpr double kLeastFreedom = 1.0;
  const VectorXd extended = with_one(step.solution);
  VectorXd squares = VectorXd::Zero(kShapeTerms);
  VectorXd freedom = VectorXd::Zero(kShapeTerms);
  for (std::size_t taxel = 0; taxel < pressed.laws.size(); ++taxel) {
    if (pressed.laws[taxel].size() == 0) continue;
    squares += (pressed.laws[taxel].bottomRows(kShapeTerms) * extended).cwiseAbs2();
    freedom.array() += 1.0 - pressed.covariance[taxel].diagonal().tail(kShapeTerms).array() / shape_variance.array();
  }
  return squares.cwiseQuotient(freedom.cwiseMax(kLeastFreedom))
      .cwiseMax(kLeastShapeSpread * kLeastShapeSpread)
      .cwiseMin(1.0);
}

/// The relative spread of the resistances of one kind.
double learn_spread(const LineGroup& group, const MatrixXd& covariance) {
  if (group.values.size() == 0) return kLineSpread;
  double square = kLineSpread * kLineSpread;
  for (std::size_t k = 0; k < group.parameters.size(); ++k) {
    square += std::pow((group.values[static_cast<Index>(k)] - group.values.mean()) / group.unit, 2);
    const Index p = group.parameters[k];
    if (p >= 0) square += covariance(p, p) / (group.unit * group.unit);
  }
  return std::sqrt(square / static_cast<double>(group.values.size()));
}

}  // namespace

Scatter learn_scatter(const LineParameters& lines, const Estimate& estimate, const Step& step, const Elimination& idle,
                      const Elimination& pressed, const std::vector<PressedReading>& readings) {
  const Rubber& rubber = estimate.rubber;
  Scatter scatter = estimate.scatter;
  scatter.noise_variance = learn_noise(idle, step, rubber.unloaded_terms, scatter.noise_variance);
  const double pressed_freedom = pressed.readings - static_cast<double>(kFreeTerms + 1) * pressed.taxels;
  if (pressed_freedom > 0.0) {
    scatter.rubber_variance = learn_rubber(readings, pressed.readings / pressed_freedom, rubber, scatter);
    scatter.shape_variance = learn_shapes(pressed, step, scatter.shape_variance);
  }
  scatter.drive_spread = learn_spread(lines.all_drives(estimate.parameters), step.covariance);
  scatter.load_spread = learn_spread(lines.all_loads(estimate.parameters), step.covariance);
  return scatter;
}

}  // namespace dermis::learn::calibration
