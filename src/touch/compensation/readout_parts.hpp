// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/axis.hpp"

namespace dermis::touch::compensation {

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

/// While a line is driven, the others of its kind stand at 0 V through their drivers.
inline bool has_grounded_idle_lines(const Readout& readout) noexcept {
  return readout.circuit == Circuit::flexitac ||
         (readout.circuit == Circuit::divider && readout.idle_rows == IdleRows::grounded);
}

/// Only the driven line carries current of a supply, so that the supply's resistance is one more of each driver.
inline bool has_supply_in_series(const ArrayDescription& array) noexcept {
  const Readout& readout = array.readout;
  if (readout.circuit == Circuit::flexitac || has_resistive_lines(readout)) return false;
  if (readout.circuit == Circuit::transimpedance && has_ideal_amplifiers(readout)) return true;
  return readout.idle_rows == IdleRows::floating;
}

/// The same circuit, its supply ideal if that can be.
inline ArrayDescription with_supply_in_drivers(ArrayDescription array) {
  if (!array.readout.supply_ohm || !has_supply_in_series(array)) return array;
  for (double& ohm : array.readout.drive_ohm) ohm += *array.readout.supply_ohm;
  array.readout.supply_ohm.reset();
  return array;
}

/// The lines along which one taxel takes from the readings of the others. They are the sensed ones where idle lines are
/// grounded, and the rows at virtual ground; other circuits have none.
inline std::optional<Axis> sharing_axis(const ArrayDescription& array) noexcept {
  if (array.readout.circuit == Circuit::transimpedance) return Axis::row;
  if (!has_grounded_idle_lines(array.readout)) return std::nullopt;
  return crossing(driven_axis(array));
}

}  // namespace dermis::touch::compensation
