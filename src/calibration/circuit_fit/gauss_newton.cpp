// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "calibration/circuit_fit/gauss_newton.hpp"

#include <cstddef>
#include <optional>
#include <utility>

#include "calibration/circuit_fit/assumptions.hpp"
#include "calibration/circuit_fit/measurements.hpp"
#include "calibration/circuit_fit/normal_equations.hpp"
#include "calibration/circuit_fit/pressed_readings.hpp"
#include "calibration/circuit_fit/scatter.hpp"
#include "calibration/circuit_fit/step.hpp"

namespace dermis::calibration {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr int kMaxIterations = 8;

Elimination eliminate_unloaded(const Measurements& measurements, const Rubber& rubber) {
  return eliminate_laws(measurements.idle, VectorXd::Ones(rubber.unloaded_terms));
}

Elimination eliminate_pressed(const Measurements& measurements, const Elimination& idle, const Rubber& rubber,
                              const Scatter& scatter) {
  constexpr double kFreePrecision = 1e-2;
  VectorXd precision(kPressedTerms);
  precision << VectorXd::Constant(kFreeTerms, kFreePrecision), scatter.shape_variance.cwiseInverse();
  return eliminate_laws(pressed_equations(measurements.pressed, idle, rubber, scatter), precision);
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
    const Eigen::MatrixXd& law = pressed.laws[taxel];
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

Result<Iteration> iterate_once(const LineParameters& lines, const std::vector<const CircuitFrame*>& frames,
                               const Estimate& before) {
  const Result<Measurements> measurements = measure(lines, frames, before, Slopes::all);
  if (!measurements) return measurements.error();
  const Elimination idle = eliminate_unloaded(*measurements, before.rubber);
  const Rubber unloaded = with_unloaded_laws(before.rubber, idle);
  const Elimination pressed = eliminate_pressed(*measurements, idle, unloaded, before.scatter);
  const std::optional<SheetComparison> sheet = compare_sheet(lines, idle);
  const Step step = solve_step(lines, idle, pressed, assumptions_at(lines, before, sheet));

  Estimate after{lines.moved(before.parameters, step.of_parameters()), with_pressed_laws(unloaded, pressed, step),
                 before.scatter};
  if (sheet) after.scatter.sheet = sheet->scatter;
  after.scatter = learn_scatter(lines, after, step, idle, pressed, measurements->pressed);
  return Iteration{std::move(after), step.covariance, step.largest(), idle.readings > 0.0, measurements->unsolved};
}

}  // namespace

Result<Iteration> iterate(const LineParameters& lines, const std::vector<const CircuitFrame*>& frames,
                          const Estimate& start, double enough) {
  Result<Iteration> last = iterate_once(lines, frames, start);
  for (int k = 1; k < kMaxIterations && last; ++k) {
    last = iterate_once(lines, frames, last->estimate);
    if (last && last->step < enough) break;
  }
  return last;
}

}  // namespace dermis::calibration
