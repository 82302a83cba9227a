// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/calibration/temperature_span.hpp"

#include <algorithm>
#include <vector>

namespace dermis::calibration {
namespace {

constexpr double kGlitches = 0.01;  // share of the samples at either end that does not count

}  // namespace

TemperatureSpan temperature_span(const SampleDatabase& database) {
  std::vector<double> temperatures;
  for (const Sample& sample : database.samples) {
    if (!sample.temperature_celsius) return {};
    temperatures.push_back(*sample.temperature_celsius);
  }
  std::sort(temperatures.begin(), temperatures.end());
  const auto glitches = static_cast<std::size_t>(kGlitches * static_cast<double>(temperatures.size()));
  const double lowest = temperatures[glitches];
  const double highest = temperatures[temperatures.size() - 1 - glitches];
  return {0.5 * (lowest + highest), 0.5 * (highest - lowest), highest - lowest >= TemperatureSpan::kLeastCelsius};
}

}  // namespace dermis::calibration
