// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <span>

namespace dermis::learn::calibration {

struct Point {
  double x = 0.0;
  double y = 0.0;
};

struct RobustLine {
  double level = 0.0;  ///< At x = 0.
  double slope = 0.0;
  double deviation = 0.0;  ///< Standard deviation of the points that were kept.

  [[nodiscard]] double residual(const Point& point) const { return point.y - level - slope * point.x; }
};

inline constexpr double kHuberSigmas = 1.345;  // 95 % of the efficiency of least squares (Huber 1964)

/// Standard deviation of the points from the line, as far as they are Gaussian.
[[nodiscard]] double median_deviation(std::span<const Point> points, const RobustLine& line);

/// One step towards Huber's estimate: least squares in which points further than `limit` > 0 from `line` count by their
/// distance, not the square of it.
[[nodiscard]] RobustLine huber_step(std::span<const Point> points, const RobustLine& line, double limit);

/// The line on which most of the points lie: least squares over those within four standard deviations of Huber's
/// estimate (1964). Each deviation is at least `least_deviation` > 0. At least one point; `has_slope`: else level.
[[nodiscard]] RobustLine fit_robust_line(std::span<const Point> points, bool has_slope, double least_deviation);

}  // namespace dermis::learn::calibration
