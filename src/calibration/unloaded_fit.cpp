// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "calibration/unloaded_fit.hpp"

#include <algorithm>
#include <cmath>

namespace dermis::calibration {
namespace {

constexpr double kLeastSpanCelsius = 2.0;      // less than this does not show a temperature coefficient
constexpr double kLeastNoiseCounts = 1.0 / 3;  // quantisation alone gives 1 / sqrt(12)
constexpr std::size_t kLeastFramesForNoise = 5;

}  // namespace

TemperatureSpan temperature_span(const SampleDatabase& database) {
  double lowest = 1e9;
  double highest = -1e9;
  for (const Sample& sample : database.samples) {
    if (!sample.temperature_celsius) return {};
    lowest = std::min(lowest, *sample.temperature_celsius);
    highest = std::max(highest, *sample.temperature_celsius);
  }
  return {0.5 * (lowest + highest), 0.5 * (highest - lowest), highest - lowest >= kLeastSpanCelsius};
}

double temperature_offset(const Sample& sample, const TemperatureSpan& span) {
  return span.is_input ? *sample.temperature_celsius - span.centre_celsius : 0.0;
}

UnloadedFit fit_unloaded(const SampleDatabase& database, const TemperatureSpan& span) {
  const std::size_t taxels = database.array.taxel_count();
  std::vector<const Sample*> unloaded;
  for (const Sample& sample : database.samples) {
    if (sample.unloaded) unloaded.push_back(&sample);
  }
  const auto frames = static_cast<double>(unloaded.size());
  double mean_offset = 0.0;
  for (const Sample* sample : unloaded) mean_offset += temperature_offset(*sample, span) / frames;
  double variance = 0.0;
  for (const Sample* sample : unloaded)
    variance += std::pow(temperature_offset(*sample, span) - mean_offset, 2) / frames;
  const bool has_slope = 4.0 * variance >= kLeastSpanCelsius * kLeastSpanCelsius;

  UnloadedFit fit;
  fit.offset_siemens.resize(taxels);
  fit.offset_per_celsius.resize(taxels);
  fit.noise_siemens.resize(taxels);
  for (std::size_t taxel = 0; taxel < taxels; ++taxel) {
    double mean = 0.0;
    double covariance = 0.0;
    for (const Sample* sample : unloaded) {
      mean += sample->siemens[taxel] / frames;
      covariance += sample->siemens[taxel] * (temperature_offset(*sample, span) - mean_offset) / frames;
    }
    const double slope = has_slope ? covariance / variance : 0.0;
    double square = 0.0;
    for (const Sample* sample : unloaded) {
      square += std::pow(sample->siemens[taxel] - mean - slope * (temperature_offset(*sample, span) - mean_offset), 2);
    }
    const double least_noise = kLeastNoiseCounts * database.siemens_per_count;
    fit.offset_siemens[taxel] = mean - slope * mean_offset;
    fit.offset_per_celsius[taxel] = slope;
    fit.noise_siemens[taxel] =
        unloaded.size() < kLeastFramesForNoise ? least_noise * 3.0 : std::max(least_noise, std::sqrt(square / frames));
  }
  return fit;
}

}  // namespace dermis::calibration
