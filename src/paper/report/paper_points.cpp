// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "paper/report/paper_points.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "dermis/out/report/estimator_table.hpp"
#include "dermis/out/report/wording.hpp"

namespace dermis::paper {

using out::report::fine_percent;
using out::report::kPaperTolerance;

std::array<PaperLevel, 3> paper_levels(const PaperReproduction& reproduction) {
  constexpr double kSameForce = 0.01;  // Relative: the loads of a level may differ by rounding.
  std::array<PaperLevel, 3> levels = {{{10.0, 11, {}}, {20.0, 12, {}}, {50.0, 13, {}}}};
  for (const PaperPoint& point : reproduction.points) {
    for (PaperLevel& level : levels) {
      if (std::abs(point.true_newtons / level.newtons - 1.0) < kSameForce) level.points.push_back(point);
    }
  }
  return levels;
}

double bank_error(const PaperPoint& point) {
  return point.bank_newtons / point.true_newtons - 1.0;
}

double dermis_error(const PaperPoint& point) {
  return point.dermis_newtons / point.true_newtons - 1.0;
}

double voltage_error(const PaperPoint& point) {
  return point.output_v / point.calibration_v - 1.0;
}

double worst_error(const std::vector<PaperPoint>& points, PointError error) {
  double worst = 0.0;
  for (const PaperPoint& point : points) {
    const double magnitude = std::abs(error(point));
    if (!std::isfinite(magnitude)) return std::numeric_limits<double>::infinity();
    worst = std::max(worst, magnitude);
  }
  return worst;
}

std::size_t count_within(const std::vector<PaperPoint>& points, PointError error) {
  return static_cast<std::size_t>(std::count_if(points.begin(), points.end(), [&](const PaperPoint& point) {
    return std::abs(error(point)) <= kPaperTolerance;
  }));
}

double mean_of(const std::vector<PaperPoint>& points, double PaperPoint::*field) {
  double sum = 0.0;
  double count = 0.0;
  for (const PaperPoint& point : points) {
    if (!std::isfinite(point.*field)) continue;
    sum += point.*field;
    count += 1.0;
  }
  return sum / count;
}

std::string worst_by_level(const PaperReproduction& reproduction, PointError error) {
  std::string words;
  for (const PaperLevel& level : paper_levels(reproduction)) {
    if (level.points.empty()) continue;
    if (!words.empty()) words += ", ";
    words += fmt::format("{:.4g}\u00a0N: {}", level.newtons, fine_percent(worst_error(level.points, error)));
  }
  return words;
}

}  // namespace dermis::paper
