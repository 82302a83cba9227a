// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/training/temperature_levels.hpp"

#include <algorithm>
#include <cstddef>
#include <span>

#include "dermis/touch/frames/quantile.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr double kAlikeForces = 1.5;       // heaviest over lightest
constexpr double kLevelShare = 1.0 / 8.0;  // of the calibrated span: temperatures that are one
constexpr double kLevelCelsius = 1.0;      // and at least
constexpr double kLevelsOfLaw = 3.0;
constexpr double kWideGap = 0.55;  // of the calibrated span: three even temperatures leave half

/// Different temperatures of `loads`, which become rising.
std::size_t count_temperatures(std::span<WarmLoad> loads, double width) {
  std::sort(loads.begin(), loads.end(), [](const auto& a, const auto& b) { return a.temperature < b.temperature; });
  std::size_t levels = 0;
  const WarmLoad* level = nullptr;
  for (const WarmLoad& load : loads) {
    if (level != nullptr && load.temperature < level->temperature + width) continue;
    level = &load;
    ++levels;
  }
  return levels;
}

bool is_pressed(const Sample& sample) {
  return std::any_of(sample.known_newtons.begin(), sample.known_newtons.end(), [](float n) { return n > 0.0F; }) ||
         std::any_of(sample.totals.begin(), sample.totals.end(), [](const auto& total) { return total.newtons > 0.0; });
}

}  // namespace

TemperaturePrior temperature_prior(std::vector<WarmLoad> loads, const TemperatureSpan& span) {
  const double width = std::max(2.0 * kLevelShare, kLevelCelsius / span.half_span_celsius);
  std::sort(loads.begin(), loads.end(), [](const auto& a, const auto& b) { return a.newtons < b.newtons; });
  std::vector<double> levels;  // of each load
  for (auto first = loads.begin(); first != loads.end();) {
    const double heaviest = kAlikeForces * first->newtons;
    const auto last = std::find_if(first, loads.end(), [&](const auto& load) { return load.newtons > heaviest; });
    const std::size_t count = count_temperatures({first, last}, width);
    levels.insert(levels.end(), static_cast<std::size_t>(last - first), static_cast<double>(count));
    first = last;
  }
  const double typical = levels.empty() ? 0.0 : upper_median(std::move(levels));
  return typical >= kLevelsOfLaw ? TemperaturePrior::free : TemperaturePrior::line;
}

std::array<double, 2> temperature_gap(const SampleDatabase& database, const SampleTemperatures& temperatures) {
  const auto& [centre, half_span] = temperatures.span;
  std::array<double, 2> gap{centre, centre};
  if (!temperatures.is_input) return gap;
  std::vector<double> celsius;
  for (const Sample& sample : database.samples) {
    if (is_pressed(sample)) celsius.push_back(*sample.temperature_celsius);
  }
  std::sort(celsius.begin(), celsius.end());
  for (std::size_t k = 1; k < celsius.size(); ++k) {
    if (celsius[k] - celsius[k - 1] > std::max(gap[1] - gap[0], 2.0 * kWideGap * half_span)) {
      gap = {celsius[k - 1], celsius[k]};
    }
  }
  return gap;
}

}  // namespace dermis::learn::calibration
