// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/calibration/uncalibrated_model.hpp"

#include "dermis/pipeline/direct_model.hpp"

namespace dermis::calibration {

pipeline::Model uncalibrated_model(const ArrayDescription& array) {
  pipeline::Model model = pipeline::direct_model(array);
  if (array.readout.quantity != Quantity::counts) return model;
  if (array.has_unknown_circuit()) {
    model.array.readout.circuit = Circuit::none;
    model.array.readout.drive_ohm.clear();
    model.array.readout.load_ohm.clear();
  }
  model.networks.dead.assign(array.taxel_count(), 1);
  return model;
}

}  // namespace dermis::calibration
