// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/pipeline/pipeline.hpp"

#include <utility>
#include <vector>

#include "dermis/touch/fusion/typical_siemens.hpp"
#include "touch/pipeline/live_noise.hpp"
#include "touch/pipeline/tare_judge.hpp"

namespace dermis::touch::pipeline {

namespace {

compensation::UnloadedConductance unloaded(const fusion::ForceNetworks& networks) {
  return {networks.unloaded, {networks.offset_sigma_siemens.begin(), networks.offset_sigma_siemens.end()}};
}

}  // namespace

Result<compensation::Compensator> make_compensator(const ArrayDescription& array,
                                                   const fusion::ForceNetworks& networks) {
  const std::vector<double> typical = fusion::typical_siemens(networks);
  std::vector<LoadPoint> loads;
  if (array.readout.film) loads = fusion::load_points(networks, typical);
  return compensation::Compensator::create(array, {typical, networks.unloaded.offset_siemens, loads});
}

Result<Pipeline> Pipeline::create(const Model& model) {
  if (Status valid = model.array.validate(); !valid) return valid.error();
  const bool is_consistent = model.networks.is_consistent() && (!model.memory || model.memory->is_consistent()) &&
                             (!model.supply || model.supply->is_consistent());
  if (model.networks.taxel_count() != model.array.taxel_count() || !is_consistent) {
    return bad_input("the model's networks do not fit its array, or hold values out of range");
  }
  Result<compensation::Compensator> compensator = make_compensator(model.array, model.networks);
  if (!compensator) return compensator.error();
  return Pipeline(model, std::move(*compensator));
}

Pipeline::Pipeline(const Model& model, compensation::Compensator compensator)
    : conditioner_(model.array, model.supply),
      compensator_(std::move(compensator)),
      monitor_(model.array, model.networks.unloaded.offset_siemens),
      drift_({model.array.rows, model.array.cols}, unloaded(model.networks)),
      live_noise_(std::make_unique<LiveNoise>(model.array, model.networks.unloaded.offset_siemens)),
      tare_judge_(std::make_unique<TareJudge>(model.networks.unloaded)),
      fusion_(model.networks) {
  if (!model.array.temperature_sensors.empty()) {
    conditioned_.taxel_celsius.reserve(model.array.taxel_count());
    conductance_.taxel_celsius.reserve(model.array.taxel_count());
  }
  if (model.memory) memory_.emplace(*model.memory, model.networks.taxel_count());
}

void Pipeline::process(const RawFrame& raw, ForceFrame& force) noexcept {
  conditioner_.process(raw, conditioned_);  // unit 2: validated, supply divided out
  live_noise_->raise(conditioned_);
  compensator_.process(conditioned_, conductance_);  // unit 3: crosstalk solved
  if (monitor_.observe(conditioned_, conductance_)) {
    compensator_.set_faults(monitor_.faults());
    compensator_.process(conditioned_, conductance_);
  }
  if (drift_.observe(conductance_)) tare_judge_->end(drift_, conductance_, fusion_, force);
  drift_.correct(conductance_);          // zero kept at zero
  fusion_.process(conductance_, force);  // unit 4: material and temperature fused to newtons
  live_noise_->observe(conductance_, force);
  if (memory_) memory_->process(force, fusion_.noise_newtons());  // and what the material remembers
}

Pipeline::Pipeline(Pipeline&&) noexcept = default;
Pipeline& Pipeline::operator=(Pipeline&&) noexcept = default;
Pipeline::~Pipeline() = default;

double Pipeline::noise_growth() const noexcept {
  return live_noise_->measured();
}

void Pipeline::tare(TareOver over) noexcept {
  tare_judge_->begin(over);
  drift_.tare();
}

void Pipeline::undo_tare() noexcept {
  tare_judge_->undo(drift_);
}

const Tare& Pipeline::last_tare() const noexcept {
  return tare_judge_->tare();
}

}  // namespace dermis::touch::pipeline
