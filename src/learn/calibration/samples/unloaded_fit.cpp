// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/samples/unloaded_fit.hpp"

#include <algorithm>
#include <cmath>

#include "learn/calibration/robust_line.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr double kLeastNoiseCounts = 1.0 / 3;  // quantisation alone gives 1 / sqrt(12)
constexpr double kHiddenNoiseCounts = 0.75;    // whole counts may have a median deviation of 0 up to this
constexpr std::size_t kLeastFramesForNoise = 5;

/// Temperature offset and conductance of one taxel in the frames in which nothing presses.
std::vector<Point> unloaded_points(const SampleDatabase& database, std::size_t taxel,
                                   const SampleTemperatures& temperatures) {
  std::vector<Point> points;
  for (const Sample& sample : database.samples) {
    if (!sample.unloaded || sample.known_newtons[taxel] != 0.0F) continue;
    points.push_back({temperature_offset(sample, taxel, temperatures), sample.siemens[taxel]});
  }
  return points;
}

bool spans_temperatures(const std::vector<Point>& points) {
  double mean = 0.0;
  for (const Point& point : points) mean += point.x / static_cast<double>(points.size());
  double variance = 0.0;
  for (const Point& point : points) variance += std::pow(point.x - mean, 2) / static_cast<double>(points.size());
  return 4.0 * variance >= std::pow(SampleTemperatures::kLeastSpanCelsius, 2);
}

}  // namespace

double temperature_offset(const Sample& sample, const SampleTemperatures& temperatures) {
  return temperatures.is_input ? temperatures.span.offset(*sample.temperature_celsius) : 0.0;
}

double temperature_offset(const Sample& sample, std::size_t taxel, const SampleTemperatures& temperatures) {
  if (sample.taxel_celsius.empty() || !temperatures.is_input) return temperature_offset(sample, temperatures);
  return temperatures.span.offset(static_cast<double>(sample.taxel_celsius[taxel]));
}

double normalised_temperature(const Sample& sample, std::size_t taxel, const SampleTemperatures& temperatures) {
  if (!temperatures.is_input) return 0.0;
  return temperature_offset(sample, taxel, temperatures) / temperatures.span.half_span_celsius;
}

UnloadedFit fit_unloaded(const SampleDatabase& database, const SampleTemperatures& temperatures) {
  const std::size_t taxels = database.array.taxel_count();
  const double least_noise = kLeastNoiseCounts * database.siemens_per_count;
  const double hidden_noise = kHiddenNoiseCounts * database.siemens_per_count;
  UnloadedFit fit{{std::vector<double>(taxels), std::vector<double>(taxels), temperatures.span},
                  std::vector<double>(taxels),
                  std::vector<double>(taxels, least_noise),
                  std::vector<bool>(taxels)};
  for (std::size_t taxel = 0; taxel < taxels; ++taxel) {
    const std::vector<Point> points = unloaded_points(database, taxel, temperatures);
    fit.is_stuck[taxel] = points.empty();
    if (points.empty()) continue;
    const RobustLine line = fit_robust_line(points, spans_temperatures(points), hidden_noise);
    fit.law.offset_siemens[taxel] = line.level;
    fit.law.per_celsius[taxel] = line.slope;
    fit.noise_siemens[taxel] =
        points.size() < kLeastFramesForNoise ? 3.0 * least_noise : std::max(least_noise, line.deviation);
    const double fitted = line.slope == 0.0 ? 1.0 : 2.0;  // numbers of the line
    fit.offset_sigma_siemens[taxel] = fit.noise_siemens[taxel] * std::sqrt(fitted / static_cast<double>(points.size()));
  }
  return fit;
}

}  // namespace dermis::learn::calibration
