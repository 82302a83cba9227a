// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include "dermis/learn/calibration/sample_database.hpp"
#include "dermis/touch/frames/unloaded_law.hpp"

namespace dermis::learn::calibration {

/// The temperatures of a calibration: its 1st to 99th percentile, so that a glitch of the sensor does not stretch it.
struct SampleTemperatures {
  static constexpr double kLeastSpanCelsius = 3.0;  ///< Less is the noise of a sensor, not a temperature coefficient.

  TemperatureSpan span;
  bool is_input = false;  ///< Every sample has a temperature and they differ enough to learn from.
};

/// The temperatures of at least one sample.
[[nodiscard]] SampleTemperatures sample_temperatures(const SampleDatabase& database);

}  // namespace dermis::learn::calibration
