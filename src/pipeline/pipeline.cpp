// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/pipeline/pipeline.hpp"

#include <utility>

namespace dermis::pipeline {

Result<Pipeline> Pipeline::create(const Model& model) {
  if (Status valid = model.array.validate(); !valid) return valid.error();
  if (model.networks.taxel_count() != model.array.taxel_count() || !model.networks.is_consistent()) {
    return bad_input("the model's networks do not fit its array, or hold values out of range");
  }
  Result<compensation::Compensator> compensator = compensation::Compensator::create(model.array);
  if (!compensator) return compensator.error();
  return Pipeline(model, std::move(*compensator));
}

Pipeline::Pipeline(const Model& model, compensation::Compensator compensator)
    : conditioner_(model.array),
      compensator_(std::move(compensator)),
      monitor_(model.array, model.networks.offset_siemens),
      fusion_(model.networks) {}

void Pipeline::process(const RawFrame& raw, ForceFrame& force) noexcept {
  conditioner_.process(raw, conditioned_);           // unit 2: validated, supply divided out
  compensator_.process(conditioned_, conductance_);  // unit 3: crosstalk solved
  if (monitor_.observe(conditioned_, conductance_)) {
    compensator_.set_faults(monitor_.faults());
    compensator_.process(conditioned_, conductance_);
  }
  fusion_.process(conductance_, force);  // unit 4: material and temperature fused to newtons
}

}  // namespace dermis::pipeline
