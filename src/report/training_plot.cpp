// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "report/training_plot.hpp"

#include <fmt/format.h>

#include <utility>

#include "dermis/report/plot.hpp"

namespace dermis::report {
namespace {

constexpr std::size_t kMarks = 7;

std::vector<Point> points_of(const TrainingCurve& curve) {
  std::vector<Point> points;
  for (std::size_t i = 0; i < curve.step.size(); ++i) points.push_back({curve.step[i], curve.value[i]});
  return points;
}

}  // namespace

bool has_points(const TrainingCurve& curve) {
  return !curve.step.empty() && curve.step.size() == curve.value.size();
}

Drawing training_plot(const TrainingPlot& training) {
  std::vector<double> steps;
  std::vector<double> errors;
  if (training.goal) errors.push_back(*training.goal / 2.0);  // So that it does not lie on the frame.
  for (const auto& [style, curve] : training.series) {
    steps.insert(steps.end(), curve->step.begin(), curve->step.end());
    errors.insert(errors.end(), curve->value.begin(), curve->value.end());
  }
  const Axis x = nice_axis("step", Scale::logarithmic, steps);
  Plot plot(training.title, x, nice_axis(training.error, Scale::logarithmic, errors), 480.0, 350.0);
  if (training.goal) {
    plot.reference(fmt::format("goal {:.3g}", *training.goal), {{x.low, *training.goal}, {x.high, *training.goal}});
  }
  for (const auto& [style, curve] : training.series) plot.line(curve->name, style, points_of(*curve), kMarks);
  return plot.drawing();
}

}  // namespace dermis::report
