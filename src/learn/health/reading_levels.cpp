// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/health/reading_levels.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace dermis::learn::health {
namespace {

constexpr std::size_t kFewestFrames = 30;
constexpr std::size_t kFewValues = 16;    // two, each with a little noise
constexpr float kNearEnd = 0.01F;         // of the range
constexpr std::size_t kFewestAtTop = 20;  // readings

}  // namespace

ReadingLevels::ReadingLevels(const ArrayDescription& array, bool is_readout_known)
    : array_(array), is_readout_known_(is_readout_known), ranges_(array.taxel_count()) {}

void ReadingLevels::add(std::span<const float> counts) {
  for (std::size_t taxel = 0; taxel < counts.size(); ++taxel) {
    Range& range = ranges_[taxel];
    range.least = frames_ == 0 ? counts[taxel] : std::min(range.least, counts[taxel]);
    range.most = frames_ == 0 ? counts[taxel] : std::max(range.most, counts[taxel]);
  }
  ++frames_;
  zeros_ += static_cast<std::size_t>(std::count(counts.begin(), counts.end(), 0.0F));
  count_values(counts);
}

void ReadingLevels::count_values(std::span<const float> counts) {
  for (const float value : counts) {
    if (values_.size() > kFewValues) return;
    ++values_[value];
  }
}

float ReadingLevels::least() const {
  return std::min_element(ranges_.begin(), ranges_.end(),
                          [](const Range& a, const Range& b) { return a.least < b.least; })
      ->least;
}

float ReadingLevels::most() const {
  return std::max_element(ranges_.begin(), ranges_.end(),
                          [](const Range& a, const Range& b) { return a.most < b.most; })
      ->most;
}

/// The end of the ADC that is described, or else of a common one.
bool ReadingLevels::is_full_scale(float counts) const {
  const auto is_end = [&](int bits) {
    const auto end = static_cast<float>(std::exp2(bits) - 1.0);
    return counts <= end && counts >= (1.0F - kNearEnd) * end;
  };
  if (is_readout_known_) return is_end(array_.readout.adc_bits);
  constexpr int kCommonBits[] = {8, 10, 12, 14, 16};
  return std::any_of(std::begin(kCommonBits), std::end(kCommonBits), is_end);
}

std::optional<std::string> ReadingLevels::only_value() const {
  const float only = most();
  if (frames_ < kFewestFrames || least() != only || (only != 0.0F && !is_full_scale(only))) return std::nullopt;
  return fmt::format("every reading of {} frames is {:.0f}: no supply, no ground, or other pins than the program reads",
                     frames_, only);
}

std::optional<std::string> ReadingLevels::remark() const {
  const std::optional<std::string> only = only_value();
  if (!only || !may_rest_at(most())) return std::nullopt;
  return *only + "; if nothing has touched the array yet, press it and look again";
}

/// An untouched array may read so.
bool ReadingLevels::may_rest_at(float counts) const {
  return !is_readout_known_ || array_.readout.pressure_raises_reading == (counts == 0.0F);
}

/// Pressing lowers the readings, so an array at rest reads high.
std::optional<std::string> ReadingLevels::no_power() const {
  if (!is_readout_known_ || array_.readout.pressure_raises_reading) return std::nullopt;
  if (10 * zeros_ < 9 * frames_ * ranges_.size()) return std::nullopt;
  return fmt::format(
      "{:.0f} % of the readings are 0, but pressing lowers readings, so an array at rest reads high: check the supply "
      "and the pull-up resistors, or pressure_raises_reading",
      100.0 * static_cast<double>(zeros_) / static_cast<double>(frames_ * ranges_.size()));
}

std::optional<std::string> ReadingLevels::two_values() const {
  const float low = least();
  const float high = most();
  if (values_.size() > kFewValues || !is_full_scale(high)) return std::nullopt;
  const float near = kNearEnd * (high - low);
  std::size_t at_top = 0;
  for (const auto& [value, times] : values_) {
    if (value > low + near && value < high - near) return std::nullopt;
    at_top += value >= high - near ? times : 0;
  }
  if (low > near || at_top < kFewestAtTop) return std::nullopt;
  return fmt::format(
      "readings are {:.0f} or {:.0f} and nothing between: the resistor of the divider is missing, or a pin is read as "
      "digital; check the resistor from each sensed line to ground and that the pins are analogue",
      low, high);
}

std::optional<std::string> ReadingLevels::finding() const {
  if (frames_ < kFewestFrames || remark()) return std::nullopt;
  for (const auto& alone : {only_value(), no_power(), two_values()}) {
    if (alone) return alone;
  }
  return std::nullopt;
}

std::optional<float> ReadingLevels::full_scale() const {
  return is_full_scale(most()) ? std::optional(most()) : std::nullopt;
}

}  // namespace dermis::learn::health
