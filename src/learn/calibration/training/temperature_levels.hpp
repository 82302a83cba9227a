// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <array>
#include <vector>

#include "dermis/learn/calibration/sample_database.hpp"
#include "dermis/learn/calibration/sample_temperatures.hpp"
#include "learn/calibration/training/force_network.hpp"

namespace dermis::learn::calibration {

/// A known force and the temperature that it was put on at, as an input of a network.
struct WarmLoad {
  double newtons = 0.0;
  double temperature = 0.0;
};

/// How far loads show the effect of temperature: the number of temperatures at which half of them were put on about
/// alike. Where temperature follows the load, the number is one, however far both go.
[[nodiscard]] TemperaturePrior temperature_prior(std::vector<WarmLoad> loads, const TemperatureSpan& span);

/// The widest gap between temperatures at which something pressed, where it is more than half of the calibrated span.
/// As [lowest, highest] [C]; both are the centre where there is none.
[[nodiscard]] std::array<double, 2> temperature_gap(const SampleDatabase& database,
                                                    const SampleTemperatures& temperatures);

}  // namespace dermis::learn::calibration
