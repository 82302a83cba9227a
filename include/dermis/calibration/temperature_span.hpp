// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include "dermis/calibration/sample_database.hpp"

namespace dermis::calibration {

/// The temperatures of a calibration: its 1st to 99th percentile, so that a glitch of the sensor does not stretch it.
struct TemperatureSpan {
  static constexpr double kLeastCelsius = 3.0;  ///< Less is the noise of a sensor, not a temperature coefficient.

  double centre_celsius = 20.0;
  double half_span_celsius = 0.0;
  bool is_input = false;  ///< Every sample has a temperature and they differ enough to learn from.
};

/// At least one sample.
[[nodiscard]] TemperatureSpan temperature_span(const SampleDatabase& database);

}  // namespace dermis::calibration
