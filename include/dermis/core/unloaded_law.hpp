// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace dermis {

/// The temperatures of a calibration: centre +- half span.
struct TemperatureSpan {
  double centre_celsius = 20.0;
  double half_span_celsius = 0.0;  ///< >= 0

  /// A temperature from the centre [C], clamped to the span.
  [[nodiscard]] double offset(double celsius) const noexcept {
    return std::clamp(celsius - centre_celsius, -half_span_celsius, half_span_celsius);
  }
};

/// What calibration knows of the taxels when nothing touches them: offset + per_celsius * dT, dT the temperature from
/// the centre of the calibrated ones, as TemperatureSpan::offset() gives it.
struct UnloadedLaw {
  std::vector<double> offset_siemens;  ///< Conductance of the unloaded taxel at the centre temperature [taxels] [S].
  std::vector<double> per_celsius;     ///< [taxels] [S/C]
  TemperatureSpan temperature;

  /// Unloaded conductance of a taxel [S].
  [[nodiscard]] double at(std::size_t taxel, double temperature_offset) const noexcept {
    return offset_siemens[taxel] + per_celsius[taxel] * temperature_offset;
  }

  /// What `siemens` of a taxel is above its unloaded conductance [S].
  [[nodiscard]] double excess(std::size_t taxel, double siemens, double temperature_offset) const noexcept {
    return siemens - offset_siemens[taxel] - per_celsius[taxel] * temperature_offset;
  }
};

}  // namespace dermis
