// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/calibration/uncalibrated_model.hpp"

#include <algorithm>

#include "dermis/touch/pipeline/direct_model.hpp"
#include "learn/calibration/circuit_fit/circuit_trial.hpp"

namespace dermis::learn::calibration {

touch::pipeline::Model uncalibrated_model(const ArrayDescription& array) {
  touch::pipeline::Model model = touch::pipeline::direct_model(array);
  if (array.readout.quantity != Quantity::counts) return model;
  if (array.has_unknown_circuit()) model.array = without_circuit(model.array);
  model.networks.dead.assign(array.taxel_count(), 1);
  return model;
}

bool is_uncalibrated(const touch::pipeline::Model& model) {
  const auto& dead = model.networks.dead;
  return std::all_of(dead.begin(), dead.end(), [](auto is_dead) { return is_dead != 0; });
}

}  // namespace dermis::learn::calibration
