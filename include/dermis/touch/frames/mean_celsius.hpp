// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cmath>
#include <optional>
#include <span>

#include "dermis/touch/frames/frames.hpp"

namespace dermis {

/// The mean of the temperatures that are finite [C]; none without any.
[[nodiscard]] inline std::optional<double> mean_celsius(std::span<const float> sensors) noexcept {
  double sum = 0.0;
  double count = 0.0;
  for (const float celsius : sensors) {
    if (!std::isfinite(celsius)) continue;
    sum += static_cast<double>(celsius);
    ++count;
  }
  return count > 0.0 ? std::optional(sum / count) : std::nullopt;
}

/// Temperature of the array [C]: its own where there is one, else the mean of the sensors with a reading.
[[nodiscard]] inline std::optional<double> mean_celsius(const RawFrame& frame) noexcept {
  if (frame.temperature_celsius && std::isfinite(*frame.temperature_celsius)) return frame.temperature_celsius;
  return mean_celsius(std::span<const float>(frame.sensor_celsius));
}

}  // namespace dermis
