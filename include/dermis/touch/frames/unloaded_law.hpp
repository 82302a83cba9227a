// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

namespace dermis {

/// The temperatures of a calibration: centre +- half span.
struct TemperatureSpan {
  double centre_celsius = 20.0;
  double half_span_celsius = 0.0;  ///< >= 0

  /// A temperature relative to the centre [C], clamped to the span; 0 where it is not known.
  [[nodiscard]] double offset(std::optional<double> celsius) const noexcept {
    return celsius ? std::clamp(*celsius - centre_celsius, -half_span_celsius, half_span_celsius) : 0.0;
  }
};

/// Calibrated conductance of the untouched taxels: offset + per_celsius * dT. dT is the temperature relative to the
/// centre of the calibration, as TemperatureSpan::offset() gives it.
struct UnloadedLaw {
  std::vector<double> offset_siemens;  ///< Conductance of the unloaded taxel at the centre temperature [taxels] [S].
  std::vector<double> per_celsius;     ///< [taxels] [S/C]
  TemperatureSpan temperature;

  /// Unloaded conductance of a taxel [S].
  [[nodiscard]] double at(std::size_t taxel, double temperature_offset) const noexcept {
    return offset_siemens[taxel] + per_celsius[taxel] * temperature_offset;
  }

  /// `siemens` of a taxel minus its unloaded conductance [S].
  [[nodiscard]] double excess(std::size_t taxel, double siemens, double temperature_offset) const noexcept {
    return siemens - offset_siemens[taxel] - per_celsius[taxel] * temperature_offset;
  }
};

}  // namespace dermis
