// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include "dermis/touch/frames/array_description.hpp"

namespace dermis::live::sources {

/// 4x5 taxels that read a few counts unloaded and some hundred under 5 N.
inline ArrayDescription small_array() {
  ArrayDescription array;
  array.name = "small";
  array.rows = 4;
  array.cols = 5;
  array.readout.drive_ohm.assign(4, 20.0);
  array.readout.load_ohm.assign(5, 200.0);
  array.readout.adc_reference_v = 5.0;
  array.readout.supply_v = 5.0;
  return array;
}

}  // namespace dermis::live::sources
