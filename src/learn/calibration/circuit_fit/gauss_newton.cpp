// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/circuit_fit/gauss_newton.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "learn/calibration/circuit_fit/assumptions.hpp"
#include "learn/calibration/circuit_fit/measurements.hpp"
#include "learn/calibration/circuit_fit/normal_equations.hpp"
#include "learn/calibration/circuit_fit/pressed_readings.hpp"
#include "learn/calibration/circuit_fit/scatter.hpp"
#include "learn/calibration/circuit_fit/step.hpp"

namespace dermis::learn::calibration {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kMaxIterations = 8;
constexpr double kLeastShare = 0.02;     // of a step
constexpr double kSigmas = 3.0;          // of the cost, a sum of squares, by which it may rise
constexpr std::size_t kMayBeLost = 200;  // one frame in so many
constexpr int kLawIterations = 2;

/// The effect of temperature on an unloaded conductance is at most a hundred times the conductance, in any unit. The
/// level is known to a standard error.
MatrixXd unloaded_precision(const NormalEquations& idle, Index terms) {
  constexpr double kPrecision = 1e-4;
  MatrixXd precision = MatrixXd::Zero(terms, static_cast<Index>(idle.local.size()));
  for (std::size_t taxel = 0; taxel < idle.local.size(); ++taxel) {
    if (idle.readings[taxel] == 0.0) continue;
    const double weight = idle.local[taxel](0, 0);
    const double level = idle.local[taxel].row(0).tail(1).value() / weight;
    precision.col(static_cast<Index>(taxel)).tail(terms - 1).setConstant(kPrecision / (level * level + 1.0 / weight));
  }
  return precision;
}

Elimination eliminate_unloaded(const Measurements& measurements, const Estimate& estimate) {
  NormalEquations idle = measurements.idle;
  idle *= 1.0 / estimate.scatter.noise_variance;
  return eliminate_laws(idle, unloaded_precision(idle, estimate.rubber.unloaded_terms));
}

Elimination eliminate_pressed(const Measurements& measurements, const Elimination& idle, const Rubber& rubber,
                              const Scatter& scatter) {
  constexpr double kFreePrecision = 1e-2;
  VectorXd precision(kPressedTerms);
  precision << VectorXd::Constant(kFreeTerms, kFreePrecision), scatter.shape_variance.cwiseInverse();
  const auto taxels = static_cast<Index>(rubber.laws.size());
  return eliminate_laws(pressed_equations(measurements.pressed, idle, rubber, scatter), precision.replicate(1, taxels));
}

Rubber with_unloaded_laws(Rubber rubber, const Elimination& idle) {
  for (std::size_t taxel = 0; taxel < rubber.laws.size(); ++taxel) {
    if (idle.laws[taxel].size() > 0) rubber.laws[taxel].unloaded = idle.laws[taxel].rightCols(1);
  }
  return rubber;
}

Rubber with_pressed_laws(Rubber rubber, const Elimination& pressed, const Step& step) {
  const Index unknowns = step.solution.size();
  rubber.sheet = step.sheet();
  for (std::size_t taxel = 0; taxel < rubber.laws.size(); ++taxel) {
    const MatrixXd& law = pressed.laws[taxel];
    if (law.size() == 0) continue;
    rubber.laws[taxel].pressed = law.leftCols(unknowns) * step.solution + law.col(unknowns);
    rubber.laws[taxel].pressed.tail(kShapeTerms) += rubber.sheet.head(kShapeTerms);
  }
  return rubber;
}

std::vector<Assumption> assumptions_at(const LineParameters& lines, const Estimate& estimate,
                                       const std::optional<SheetComparison>& sheet) {
  std::vector<Assumption> all;
  if (sheet) all = sheet->assumptions;
  for (Assumption& assumption : alike_lines(lines, estimate)) all.push_back(std::move(assumption));
  for (Assumption& assumption : nominal_scale(lines, estimate.parameters)) all.push_back(std::move(assumption));
  return all;
}

/// The measurements of an estimate, the laws eliminated, and the step that follows.
struct Linearisation {
  Rubber unloaded;  // with its unloaded laws
  Elimination idle;
  Elimination pressed;
  std::optional<SheetComparison> sheet;
  Step step;
  double cost = 0.0;  // at no step
};

Linearisation linearise(const LineParameters& lines, const Measurements& measurements, const Estimate& estimate) {
  Linearisation result;
  result.idle = eliminate_unloaded(measurements, estimate);
  result.unloaded = with_unloaded_laws(estimate.rubber, result.idle);
  result.pressed = eliminate_pressed(measurements, result.idle, result.unloaded, estimate.scatter);
  result.sheet = compare_sheet(lines, result.idle);
  const std::vector<Assumption> assumptions = assumptions_at(lines, estimate, result.sheet);
  result.step = solve_step(lines, result.idle, result.pressed, assumptions);
  result.cost = cost_without_step(lines, result.idle, result.pressed, assumptions);
  return result;
}

double readings_of(const Linearisation& linearisation) {
  return linearisation.idle.readings + linearisation.pressed.readings;
}

/// By how much the residual of an estimate exceeds that of `here`, both with the given scatter and for as many
/// readings.
double rise_from(const Linearisation& here, const LineParameters& lines, const Measurements& measurements,
                 Estimate estimate, const Scatter& scatter) {
  estimate.scatter = scatter;
  const Linearisation there = linearise(lines, measurements, estimate);
  return there.cost * readings_of(here) / readings_of(there) - here.cost;
}

/// The estimate after a share of the step; the scatter is the one that the whole step would leave.
Iteration follow(const LineParameters& lines, const Linearisation& here, const Measurements& measurements,
                 const Estimate& before, double share) {
  Step step = here.step;
  step.shorten(share);
  Estimate after{lines.moved(before.parameters, step.of_parameters()),
                 with_pressed_laws(here.unloaded, here.pressed, step), before.scatter};
  if (here.sheet) after.scatter.sheet = here.sheet->scatter;
  after.scatter = learn_scatter(lines, after, step, here.idle, here.pressed, measurements.pressed);
  return {std::move(after), here.step.covariance, here.step.largest(), here.idle.readings > 0.0};
}

}  // namespace

// Where a conductance follows from the little that a reading leaves of the supply, a step may be far too long. It is
// halved until it loses no frames and the cost rises by no more than chance. All steps together may rise by that much.
// Where no share of the step does, the fit ends.
Result<Iteration> iterate(const LineParameters& lines, const std::vector<const CircuitFrame*>& frames,
                          const Estimate& start, double enough) {
  Result<Measurements> measurements = measure(lines, frames, start);
  if (!measurements) return measurements.error();
  const std::size_t most_lost = measurements->lost_frames + frames.size() / kMayBeLost;
  Linearisation here = linearise(lines, *measurements, start);
  Iteration last = follow(lines, here, *measurements, start, 1.0);
  Estimate before = start;
  const double chance = kSigmas * std::sqrt(2.0 * readings_of(here));
  double allowed = chance;
  for (int k = 1;; ++k) {
    for (double share = 0.5;; share *= 0.5) {
      Result<Measurements> next = measure(lines, frames, last.estimate);
      if (!next) return next.error();
      const double rise = rise_from(here, lines, *next, last.estimate, before.scatter);
      if (next->lost_frames <= most_lost && !(rise > allowed)) {
        allowed = std::min(chance, allowed - rise);
        measurements = std::move(next);
        break;
      }
      if (share < kLeastShare) return follow(lines, here, *measurements, before, 0.0);
      last = follow(lines, here, *measurements, before, share);
    }
    if (k == kMaxIterations || (k > 1 && last.step < enough)) return last;
    before = last.estimate;
    here = linearise(lines, *measurements, before);
    last = follow(lines, here, *measurements, before, 1.0);
  }
}

Iteration fit_laws(const LineParameters& known, const InvertedFrames& inverted,
                   const std::vector<const CircuitFrame*>& frames, const Estimate& start) {
  Estimate estimate = start;
  Iteration last;
  for (int k = 0; k < kLawIterations; ++k) {
    const Measurements measurements = measure(inverted, frames, estimate);
    last = follow(known, linearise(known, measurements, estimate), measurements, estimate, 1.0);
    estimate = last.estimate;
  }
  return last;
}

}  // namespace dermis::learn::calibration
