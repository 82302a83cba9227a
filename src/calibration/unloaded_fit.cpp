// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "calibration/unloaded_fit.hpp"

#include <algorithm>
#include <cmath>

namespace dermis::calibration {
namespace {

constexpr double kLeastNoiseCounts = 1.0 / 3;  // quantisation alone gives 1 / sqrt(12)
constexpr std::size_t kLeastFramesForNoise = 5;

/// Conductance of one taxel and the temperature, in a frame in which nothing presses.
struct UnloadedPoint {
  double siemens = 0.0;
  double temperature_offset = 0.0;
};

std::vector<UnloadedPoint> unloaded_points(const SampleDatabase& database, std::size_t taxel,
                                           const SampleTemperatures& temperatures) {
  std::vector<UnloadedPoint> points;
  for (const Sample& sample : database.samples) {
    if (!sample.unloaded || sample.known_newtons[taxel] != 0.0F) continue;
    points.push_back({sample.siemens[taxel], temperature_offset(sample, temperatures)});
  }
  return points;
}

struct Line {
  double level = 0.0;  // at the centre temperature
  double slope = 0.0;
  double deviation = 0.0;
};

Line fit_line(const std::vector<UnloadedPoint>& points) {
  const auto count = static_cast<double>(points.size());
  double mean_y = 0.0;
  double mean_x = 0.0;
  for (const UnloadedPoint& point : points) {
    mean_y += point.siemens / count;
    mean_x += point.temperature_offset / count;
  }
  double covariance = 0.0;
  double variance = 0.0;
  for (const UnloadedPoint& point : points) {
    covariance += (point.siemens - mean_y) * (point.temperature_offset - mean_x) / count;
    variance += std::pow(point.temperature_offset - mean_x, 2) / count;
  }
  const bool has_slope = 4.0 * variance >= std::pow(SampleTemperatures::kLeastSpanCelsius, 2);
  const double slope = has_slope ? covariance / variance : 0.0;
  double square = 0.0;
  for (const UnloadedPoint& point : points) {
    square += std::pow(point.siemens - mean_y - slope * (point.temperature_offset - mean_x), 2) / count;
  }
  return {mean_y - slope * mean_x, slope, std::sqrt(square)};
}

}  // namespace

double temperature_offset(const Sample& sample, const SampleTemperatures& temperatures) {
  return temperatures.is_input ? temperatures.span.offset(*sample.temperature_celsius) : 0.0;
}

double normalised_temperature(const Sample& sample, const SampleTemperatures& temperatures) {
  return temperatures.is_input ? temperature_offset(sample, temperatures) / temperatures.span.half_span_celsius : 0.0;
}

UnloadedFit fit_unloaded(const SampleDatabase& database, const SampleTemperatures& temperatures) {
  const std::size_t taxels = database.array.taxel_count();
  const double least_noise = kLeastNoiseCounts * database.siemens_per_count;
  UnloadedFit fit{{std::vector<double>(taxels), std::vector<double>(taxels), temperatures.span},
                  std::vector<double>(taxels),
                  std::vector<double>(taxels, least_noise),
                  std::vector<bool>(taxels)};
  for (std::size_t taxel = 0; taxel < taxels; ++taxel) {
    const std::vector<UnloadedPoint> points = unloaded_points(database, taxel, temperatures);
    fit.is_stuck[taxel] = points.empty();
    if (points.empty()) continue;
    const Line line = fit_line(points);
    fit.law.offset_siemens[taxel] = line.level;
    fit.law.per_celsius[taxel] = line.slope;
    fit.noise_siemens[taxel] =
        points.size() < kLeastFramesForNoise ? 3.0 * least_noise : std::max(least_noise, line.deviation);
    const double fitted = line.slope == 0.0 ? 1.0 : 2.0;  // numbers of the line
    fit.offset_sigma_siemens[taxel] = fit.noise_siemens[taxel] * std::sqrt(fitted / static_cast<double>(points.size()));
  }
  return fit;
}

}  // namespace dermis::calibration
