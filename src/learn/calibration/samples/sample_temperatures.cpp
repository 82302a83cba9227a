// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/calibration/sample_temperatures.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "dermis/touch/frames/quantile.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr double kGlitches = 0.01;  // share of the samples at either end that does not count

/// Lowest and highest, without glitches.
std::pair<double, double> span_of(std::vector<double> celsius) {
  const auto glitches = static_cast<std::size_t>(kGlitches * static_cast<double>(celsius.size()));
  const double lowest = ranked(celsius, glitches);
  const std::size_t last = celsius.size() - 1 - glitches;
  return {lowest, ranked(std::move(celsius), last)};
}

/// The widest half span that one taxel has seen: where the sheet has a gradient that stays, no taxel has seen what
/// another one has.
double widest_half_span(const SampleDatabase& database) {
  double widest = 0.0;
  for (std::size_t taxel = 0; taxel < database.array.taxel_count(); ++taxel) {
    std::vector<double> celsius;
    for (const Sample& sample : database.samples) {
      celsius.push_back(sample.taxel_celsius.empty() ? *sample.temperature_celsius
                                                     : static_cast<double>(sample.taxel_celsius[taxel]));
    }
    const auto [lowest, highest] = span_of(std::move(celsius));
    widest = std::max(widest, 0.5 * (highest - lowest));
  }
  return widest;
}

}  // namespace

SampleTemperatures sample_temperatures(const SampleDatabase& database) {
  std::vector<double> celsius;
  for (const Sample& sample : database.samples) {
    if (!sample.temperature_celsius) return {};
    celsius.push_back(*sample.temperature_celsius);
    celsius.insert(celsius.end(), sample.taxel_celsius.begin(), sample.taxel_celsius.end());
  }
  const bool is_map = celsius.size() > database.samples.size();
  const auto [lowest, highest] = span_of(std::move(celsius));
  double half_span = 0.5 * (highest - lowest);
  if (is_map) half_span = std::min(half_span, widest_half_span(database));
  return {{0.5 * (lowest + highest), half_span}, 2.0 * half_span >= SampleTemperatures::kLeastSpanCelsius};
}

}  // namespace dermis::learn::calibration
