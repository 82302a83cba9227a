// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/calibration/uncalibrated_model.hpp"

#include <limits>

namespace dermis::calibration {

pipeline::Model uncalibrated_model(const ArrayDescription& array) {
  pipeline::Model model;
  model.array = array;
  if (array.has_unknown_circuit()) {
    model.array.readout.circuit = Circuit::none;
    model.array.readout.drive_ohm.clear();
    model.array.readout.load_ohm.clear();
  }
  const std::size_t taxels = array.taxel_count();
  fusion::ForceNetworks& networks = model.networks;
  networks.shape = {2, 0, 2};
  networks.unloaded.offset_siemens.assign(taxels, 0.0);
  networks.unloaded.per_celsius.assign(taxels, 0.0);
  networks.reference_siemens.assign(taxels, 1.0F);
  networks.heaviest_siemens.assign(taxels, 1.0F);
  networks.heaviest_newtons.assign(taxels, std::numeric_limits<float>::infinity());
  networks.gain.assign(taxels, 1.0F);
  networks.dead.assign(taxels, 1);
  networks.parameters.assign(networks.shape.parameter_count() * taxels, 0.0F);
  networks.offset_sigma_siemens.assign(taxels, 0.0F);
  networks.relative_sigma.assign(fusion::kSigmaKnots * taxels, 1.0F);
  return model;
}

}  // namespace dermis::calibration
