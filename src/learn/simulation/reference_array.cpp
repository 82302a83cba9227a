// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/simulation/reference_array.hpp"

#include "dermis/learn/simulation/rubber.hpp"

namespace dermis::learn::simulation {

ArrayDescription reference_array(FrameShape shape) {
  ArrayDescription array;
  array.name = "chest";
  array.rows = shape.rows;
  array.cols = shape.cols;
  array.taxel_area_m2 = kPaperDiscAreaM2;
  array.readout.drive_ohm.assign(shape.rows, 20.0);
  array.readout.load_ohm.assign(shape.cols, 200.0);
  array.readout.adc_reference_v = 5.0;
  array.readout.supply_v = 5.0;
  return array;
}

}  // namespace dermis::learn::simulation
