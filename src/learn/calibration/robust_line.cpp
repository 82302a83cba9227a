// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/robust_line.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "dermis/touch/frames/quantile.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr double kSigmasPerMedianDeviation = 1.4826;  // of Gaussian noise
constexpr double kKeptSigmas = 4.0;
constexpr int kMostRounds = 30;

/// Weighted least squares; means and moments in one pass (West 1979).
template <typename Weight>
RobustLine fit_weighted(std::span<const Point> points, bool has_slope, const Weight& weight_of) {
  double weights = 0.0;
  double x = 0.0;
  double y = 0.0;
  double variance = 0.0;
  double covariance = 0.0;
  for (const Point& point : points) {
    const double weight = weight_of(point);
    if (weight == 0.0) continue;
    weights += weight;
    const double from_mean = point.x - x;
    x += weight / weights * from_mean;
    y += weight / weights * (point.y - y);
    variance += weight * from_mean * (point.x - x);
    covariance += weight * from_mean * (point.y - y);
  }
  RobustLine line;
  line.slope = has_slope && variance > 0.0 ? covariance / variance : 0.0;
  line.level = y - line.slope * x;
  return line;
}

/// The line of this slope with half of the points above it.
RobustLine median_line(std::span<const Point> points, double slope) {
  RobustLine line;
  line.slope = slope;
  std::vector<double> residuals;
  residuals.reserve(points.size());
  for (const Point& point : points) residuals.push_back(line.residual(point));
  line.level = upper_median(std::move(residuals));
  return line;
}

/// The slope is Huber's, about the level of the median, which outliers on one side move less.
RobustLine fit_huber(std::span<const Point> points, double least_deviation) {
  RobustLine line = median_line(points, 0.0);
  for (int round = 0; round < kMostRounds; ++round) {
    const double limit = kHuberSigmas * std::max(median_deviation(points, line), least_deviation);
    const RobustLine next = median_line(points, huber_step(points, line, limit).slope);
    double change = 0.0;
    for (const Point& point : points) change = std::max(change, std::abs(next.residual(point) - line.residual(point)));
    line = next;
    if (change < 0.01 * limit) break;
  }
  return line;
}

}  // namespace

double median_deviation(std::span<const Point> points, const RobustLine& line) {
  std::vector<double> deviations;
  deviations.reserve(points.size());
  for (const Point& point : points) deviations.push_back(std::abs(line.residual(point)));
  return kSigmasPerMedianDeviation * upper_median(std::move(deviations));
}

RobustLine huber_step(std::span<const Point> points, const RobustLine& line, double limit) {
  return fit_weighted(points, true,
                      [&](const Point& point) { return limit / std::max(limit, std::abs(line.residual(point))); });
}

RobustLine fit_robust_line(std::span<const Point> points, bool has_slope, double least_deviation) {
  const RobustLine most = has_slope ? fit_huber(points, least_deviation) : median_line(points, 0.0);
  const double limit = kKeptSigmas * std::max(median_deviation(points, most), least_deviation);
  const auto is_kept = [&](const Point& point) { return std::abs(most.residual(point)) <= limit; };
  RobustLine line = fit_weighted(points, has_slope, [&](const Point& point) { return is_kept(point) ? 1.0 : 0.0; });
  double square = 0.0;
  double kept = 0.0;
  for (const Point& point : points) {
    if (!is_kept(point)) continue;
    square += std::pow(line.residual(point), 2);
    kept += 1.0;
  }
  line.deviation = std::sqrt(square / kept);
  return line;
}

}  // namespace dermis::learn::calibration
