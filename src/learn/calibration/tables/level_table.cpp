// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/tables/level_table.hpp"

#include <algorithm>
#include <cstddef>

namespace dermis::learn::calibration {
namespace {

constexpr std::size_t kMaxKnots = 64;
constexpr double kLevelWidth = 1.03;              // heaviest over lightest force of one level
constexpr double kLeastTemperatureFactor = 0.01;  // a linear term ends before it turns the signal round

/// Calls visit(level) for every run of points of about equal force: labels weighed by a load cell scatter.
template <typename Visit>
void for_each_level(std::span<LevelPoint> points, Visit visit) {
  for (std::size_t first = 0; first < points.size();) {
    std::size_t last = first + 1;
    while (last < points.size() && points[last].newtons <= kLevelWidth * points[first].newtons) ++last;
    visit(points.subspan(first, last - first));
    first = last;
  }
}

double mean(std::span<const LevelPoint> level, double LevelPoint::*member) {
  double sum = 0.0;
  for (const LevelPoint& point : level) sum += point.*member;
  return sum / static_cast<double>(level.size());
}

}  // namespace

double temperature_coefficient(std::span<LevelPoint> points) {
  double covariance = 0.0;
  double variance = 0.0;
  for_each_level(points, [&](std::span<const LevelPoint> level) {
    const double signal = mean(level, &LevelPoint::signal);
    if (level.front().newtons <= 0.0 || signal <= 0.0) return;
    for (const LevelPoint& point : level) {
      covariance += (point.signal / signal - 1.0) * point.temperature_offset;
      variance += point.temperature_offset * point.temperature_offset;
    }
  });
  return variance > 0.0 ? -covariance / variance : 0.0;
}

std::vector<Knot> level_table(std::vector<LevelPoint> points, double coefficient) {
  for (LevelPoint& point : points) {
    point.signal *= std::max(1.0 + coefficient * point.temperature_offset, kLeastTemperatureFactor);
  }
  std::vector<Knot> knots;
  for_each_level(points, [&](std::span<const LevelPoint> level) {
    knots.push_back(
        {mean(level, &LevelPoint::newtons), mean(level, &LevelPoint::signal), static_cast<double>(level.size())});
  });
  thin_out(knots, kMaxKnots);
  pool_adjacent_violators(knots);
  return knots;
}

}  // namespace dermis::learn::calibration
