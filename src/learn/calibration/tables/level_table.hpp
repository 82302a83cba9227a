// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <span>
#include <vector>

#include "learn/calibration/tables/monotone_knots.hpp"

namespace dermis::learn::calibration {

/// Signal of one taxel at a known force.
struct LevelPoint {
  double newtons = 0.0;
  double signal = 0.0;
  double temperature_offset = 0.0;  ///< From the reference [C].
};

/// The k of signal * (1 + k dT) that makes the signals of equal force agree best; `points` by rising force.
[[nodiscard]] double temperature_coefficient(std::span<LevelPoint> points);

/// Newtons and signal at the reference, both rising, with a knot at every force of `points` (at most 64, in equal
/// shares beyond). Points are by rising force. A knot has the mean signal there; falling neighbours are pooled.
[[nodiscard]] std::vector<Knot> level_table(std::vector<LevelPoint> points, double coefficient);

}  // namespace dermis::learn::calibration
