// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/calibration/sample_temperatures.hpp"

#include <algorithm>
#include <vector>

namespace dermis::calibration {
namespace {

constexpr double kGlitches = 0.01;  // share of the samples at either end that does not count

}  // namespace

SampleTemperatures sample_temperatures(const SampleDatabase& database) {
  std::vector<double> celsius;
  for (const Sample& sample : database.samples) {
    if (!sample.temperature_celsius) return {};
    celsius.push_back(*sample.temperature_celsius);
    celsius.insert(celsius.end(), sample.taxel_celsius.begin(), sample.taxel_celsius.end());
  }
  std::sort(celsius.begin(), celsius.end());
  const auto glitches = static_cast<std::size_t>(kGlitches * static_cast<double>(celsius.size()));
  const double lowest = celsius[glitches];
  const double highest = celsius[celsius.size() - 1 - glitches];
  return {{0.5 * (lowest + highest), 0.5 * (highest - lowest)},
          highest - lowest >= SampleTemperatures::kLeastSpanCelsius};
}

}  // namespace dermis::calibration
