// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include "dermis/learn/simulation/rubber.hpp"
#include "dermis/touch/pipeline/model.hpp"
#include "support/random_networks.hpp"

namespace dermis {

/// Of an array that was not calibrated, for what only takes time.
inline touch::pipeline::Model random_model(const ArrayDescription& array) {
  touch::pipeline::Model model;
  model.array = array;
  model.networks = support::random_networks(array.taxel_count(), touch::fusion::kInputsWithTemperature, 4, 1);
  // What the simulated array is, unloaded: else its taxels are found to be dead.
  model.networks.unloaded.offset_siemens.assign(array.taxel_count(),
                                                1.0 / learn::simulation::RubberOptions{}.unloaded_ohm);
  return model;
}

}  // namespace dermis
