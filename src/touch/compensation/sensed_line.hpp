// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>

#include "dermis/touch/frames/array_description.hpp"

namespace dermis::touch::compensation {

/// The head of a sensed line: a resistance rho to a source emf (over the supply). The reading is r = gain I + offset
/// for the current I that leaves the line [1 V of supply / ohm].
struct SensedLine {
  double rho = 0.0;
  double gain = 0.0;
  double offset = 0.0;
  double emf = 0.0;
  double rho_by_load = 1.0;   ///< d rho / d load_ohm
  double gain_by_load = 1.0;  ///< d gain / d load_ohm
};

/// A load is the resistance itself, behind the switch where lines share one. An amplifier of open-loop gain A0 and
/// offset off (over the supply) reads r = (I RL - off) / (1 + 1/A0). It holds its input, behind the column's switch, at
/// off A0 / (1 + A0) + I RL / (1 + A0).
inline SensedLine sensed_line(const Readout& readout, std::size_t line) noexcept {
  const double load = readout.load_ohm[line];
  const double column_switch = readout.column_switch_ohm.empty() ? 0.0 : readout.column_switch_ohm[line];
  if (readout.circuit != Circuit::transimpedance) return {load + column_switch, load};
  const double inverse_gain = readout.amplifier_gain ? 1.0 / *readout.amplifier_gain : 0.0;
  const double off = readout.amplifier_offset_v.empty() ? 0.0 : readout.amplifier_offset_v[line] / *readout.supply_v;
  SensedLine sensed;
  sensed.gain_by_load = 1.0 / (1.0 + inverse_gain);
  sensed.rho_by_load = inverse_gain * sensed.gain_by_load;
  sensed.rho = column_switch + load * sensed.rho_by_load;
  sensed.gain = load * sensed.gain_by_load;
  sensed.emf = off * sensed.gain_by_load;
  sensed.offset = -sensed.emf;
  return sensed;
}

}  // namespace dermis::touch::compensation
