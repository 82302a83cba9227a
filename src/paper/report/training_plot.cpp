// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "paper/report/training_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "dermis/out/report/plot.hpp"

namespace dermis::paper {

using out::report::Axis;
using out::report::Drawing;
using out::report::nice_axis;
using out::report::Plot;
using out::report::Point;
using out::report::Scale;

namespace {

constexpr std::size_t kMarks = 7;

double mean(const std::vector<double>& values, std::size_t first, std::size_t end) {
  double sum = 0.0;
  for (std::size_t i = first; i < end; ++i) sum += values[i];
  return sum / static_cast<double>(end - first);
}

std::vector<Point> points_of(const TrainingCurve& curve) {
  constexpr double kSamePlace = 1.02;
  std::vector<Point> points;
  for (std::size_t first = 0; first < curve.step.size();) {
    std::size_t end = first + 1;
    while (end < curve.step.size() && curve.step[end] < kSamePlace * curve.step[first]) ++end;
    points.push_back({mean(curve.step, first, end), mean(curve.value, first, end)});
    first = end;
  }
  return points;
}

}  // namespace

bool has_points(const TrainingCurve& curve) {
  return !curve.step.empty() && curve.step.size() == curve.value.size();
}

double final_error(const TrainingCurve& curve) {
  const std::size_t count = curve.value.size();
  return mean(curve.value, count - std::max<std::size_t>(count / 10, 1), count);
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

}  // namespace dermis::paper
