// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <vector>

#include "dermis/core/array_description.hpp"

namespace dermis::compensation {

/// A list may be absent or all zero: both mean that the part is not there.
inline bool is_absent(const std::vector<double>& values) noexcept {
  return std::all_of(values.begin(), values.end(), [](double value) { return value == 0.0; });
}

inline bool has_resistive_lines(const Readout& readout) noexcept {
  return !is_absent(readout.row_segment_ohm) || !is_absent(readout.column_segment_ohm);
}

inline bool has_ideal_amplifiers(const Readout& readout) noexcept {
  return is_absent(readout.column_switch_ohm) && is_absent(readout.amplifier_offset_v) && !readout.amplifier_gain;
}

}  // namespace dermis::compensation
