// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>

#include "dermis/touch/frames/array_description.hpp"

namespace dermis::support {

/// The resistors of the reference array, for any size and circuit: drivers of 20 ohm, loads of 200 ohm. A reading is a
/// share of the supply.
inline ArrayDescription reference_circuit(std::size_t rows = 16, std::size_t cols = 16,
                                          Circuit circuit = Circuit::divider) {
  ArrayDescription array;
  array.rows = rows;
  array.cols = cols;
  array.readout.circuit = circuit;
  array.readout.drive_ohm.assign(array.driven_lines(), 20.0);
  array.readout.load_ohm.assign(array.sensed_lines(), 200.0);
  return array;
}

/// The reference array: those resistors, 5 V for the supply and for the ADC, discs of 7 mm.
inline ArrayDescription reference_array(std::size_t rows = 16, std::size_t cols = 16) {
  ArrayDescription array = reference_circuit(rows, cols);
  array.taxel_area_m2 = 38.48e-6;
  array.readout.adc_reference_v = 5.0;
  array.readout.supply_v = 5.0;
  return array;
}

}  // namespace dermis::support
