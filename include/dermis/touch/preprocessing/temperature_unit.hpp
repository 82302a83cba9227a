// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <optional>

#include "dermis/touch/frames/frames.hpp"

namespace dermis::touch::preprocessing {

/// No sheet is hotter than 200 C. In kelvin that would be -73 C, and none is colder.
[[nodiscard]] constexpr bool looks_like_kelvin(double celsius) noexcept {
  constexpr double kHottestCelsius = 200.0;
  return celsius > kHottestCelsius;
}

/// The temperature of a frame, or the first of its sensors, that looks like kelvin.
[[nodiscard]] inline std::optional<double> kelvin_in(const RawFrame& frame) {
  if (frame.temperature_celsius && looks_like_kelvin(*frame.temperature_celsius)) return frame.temperature_celsius;
  const auto found =
      std::ranges::find_if(frame.sensor_celsius, [](float celsius) { return looks_like_kelvin(celsius); });
  return found == frame.sensor_celsius.end() ? std::nullopt : std::optional<double>(*found);
}

}  // namespace dermis::touch::preprocessing
