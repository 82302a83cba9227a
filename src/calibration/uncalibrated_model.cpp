// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/calibration/uncalibrated_model.hpp"

#include <algorithm>

#include "calibration/circuit_fit/circuit_trial.hpp"
#include "dermis/pipeline/direct_model.hpp"

namespace dermis::calibration {

pipeline::Model uncalibrated_model(const ArrayDescription& array) {
  pipeline::Model model = pipeline::direct_model(array);
  if (array.readout.quantity != Quantity::counts) return model;
  if (array.has_unknown_circuit()) model.array = without_circuit(model.array);
  model.networks.dead.assign(array.taxel_count(), 1);
  return model;
}

bool is_uncalibrated(const pipeline::Model& model) {
  const auto& dead = model.networks.dead;
  return std::all_of(dead.begin(), dead.end(), [](auto is_dead) { return is_dead != 0; });
}

}  // namespace dermis::calibration
