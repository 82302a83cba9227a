// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/pipeline/pipeline.hpp"

#include <utility>

namespace dermis::pipeline {

Result<Pipeline> Pipeline::create(const Model& model) {
  Result<compensation::Compensator> compensator = compensation::Compensator::create(model.array);
  if (!compensator) return compensator.error();
  return Pipeline(model, std::move(*compensator));
}

Pipeline::Pipeline(const Model& model, compensation::Compensator compensator)
    : conditioner_(model.array), compensator_(std::move(compensator)), fusion_(model.networks) {}

void Pipeline::process(const RawFrame& raw, ForceFrame& force) noexcept {
  conditioner_.process(raw, conditioned_);             // unit 2: validated, supply divided out
  compensator_.process(conditioned_, conductance_);    // unit 3: crosstalk solved
  fusion_.process(conductance_, force);                // unit 4: material and temperature fused to newtons
}

}  // namespace dermis::pipeline
