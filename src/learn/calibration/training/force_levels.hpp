// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <vector>

namespace dermis::learn::calibration {

/// Heaviest over lightest load that determine a power of conductance.
inline constexpr double kLeastForceRange = 2.0;

/// Forces that are needed to determine how the power changes with the load; the level and the power take two.
inline constexpr std::size_t kLeastLevelsOfBend = 3;

/// Different forces of a calibration; labels weighed by a load cell scatter about their level.
[[nodiscard]] inline std::size_t count_levels(const std::vector<double>& rising_newtons) {
  constexpr double kLevelWidth = 1.05;
  std::size_t levels = 0;
  double level = 0.0;
  for (const double newtons : rising_newtons) {
    if (newtons <= kLevelWidth * level) continue;
    level = newtons;
    ++levels;
  }
  return levels;
}

}  // namespace dermis::learn::calibration
