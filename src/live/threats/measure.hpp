// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>

#include "dermis/live/threats/threat_monitor.hpp"
#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/contacts.hpp"
#include "dermis/touch/frames/frames.hpp"

/// The values of one frame for the limits.
namespace dermis::live::threats {

/// The taxels of an array that a limit is for.
struct Area {
  std::size_t rows = 0;  // of the array
  std::size_t cols = 0;
  double row_pitch_m = 0.0;
  double col_pitch_m = 0.0;
  double taxel_area_m2 = 0.0;  // 0: not known
  std::size_t first_row = 0;
  std::size_t last_row = 0;
  std::size_t first_col = 0;
  std::size_t last_col = 0;

  [[nodiscard]] static Area whole(const ArrayDescription& array);

  /// Nearer to one of its taxels than to others; beyond the edge of the array counts to its border.
  [[nodiscard]] bool contains(const PlaneVector& position) const noexcept;
  [[nodiscard]] PlaneVector place_of(std::size_t row, std::size_t col) const noexcept;
};

/// Measures all but force_rate, which takes several frames. 0 where nothing presses.
[[nodiscard]] ThreatValue measure(const ThreatLimit& limit, const Area& area, const ForceFrame& force,
                                  const ContactReport& report) noexcept;

/// The force on the taxels of the area, at least 0; its position is that of the taxels that stand out of the noise.
[[nodiscard]] ThreatValue total_force(const Area& area, const ForceFrame& force) noexcept;

}  // namespace dermis::live::threats
