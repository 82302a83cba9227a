// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/pipeline/pipeline.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

#include "dermis/core/quantile.hpp"
#include "pipeline/tare_judge.hpp"

namespace dermis::pipeline {

namespace {

/// Conductance of every taxel under a force that is typical for the array [S], > 0; of a dead taxel the median of the
/// others, and 1 where the networks tell nothing.
std::vector<double> typical_siemens(const fusion::ForceNetworks& networks) {
  const std::size_t taxels = networks.taxel_count();
  fusion::ForceFusion fusion(networks);
  ConductanceFrame conductance;
  conductance.temperature_celsius = networks.unloaded.temperature.centre_celsius;
  conductance.siemens.resize(taxels);
  conductance.sigma_siemens.assign(taxels, 0.0);
  conductance.taxels.assign(taxels, TaxelStatus::ok);
  ForceFrame force;
  const auto press = [&](const std::vector<double>& share) {
    for (std::size_t taxel = 0; taxel < taxels; ++taxel) {
      conductance.siemens[taxel] = networks.unloaded.offset_siemens[taxel] +
                                   share[taxel] * static_cast<double>(networks.reference_siemens[taxel]);
    }
    fusion.process(conductance, force);
  };

  press(std::vector<double>(taxels, 1.0));
  std::vector<float> newtons;
  std::copy_if(force.newtons.begin(), force.newtons.end(), std::back_inserter(newtons),
               [](float value) { return std::isfinite(value); });
  if (newtons.empty()) return std::vector<double>(taxels, 1.0);
  const float typical_newtons = upper_median(std::move(newtons));

  std::vector<double> share(taxels, 1.0);
  for (double factor = 8.0; factor > 1.0 + 1e-6; factor = std::sqrt(factor)) {
    press(share);
    for (std::size_t taxel = 0; taxel < taxels; ++taxel) {
      share[taxel] *= force.newtons[taxel] < typical_newtons ? factor : 1.0 / factor;
    }
  }
  press(share);
  std::vector<double>& siemens = conductance.siemens;
  const auto tells = [&](std::size_t taxel) { return std::isfinite(force.newtons[taxel]) && siemens[taxel] > 0.0; };
  std::vector<double> told;
  for (std::size_t taxel = 0; taxel < taxels; ++taxel) {
    if (tells(taxel)) told.push_back(siemens[taxel]);
  }
  if (told.empty()) return std::vector<double>(taxels, 1.0);
  const double median = upper_median(std::move(told));
  for (std::size_t taxel = 0; taxel < taxels; ++taxel) {
    if (!tells(taxel)) siemens[taxel] = median;
  }
  return siemens;
}

compensation::UnloadedConductance unloaded(const fusion::ForceNetworks& networks) {
  return {networks.unloaded, {networks.offset_sigma_siemens.begin(), networks.offset_sigma_siemens.end()}};
}

}  // namespace

Result<Pipeline> Pipeline::create(const Model& model) {
  if (Status valid = model.array.validate(); !valid) return valid.error();
  const bool is_consistent = model.networks.is_consistent() && (!model.memory || model.memory->is_consistent()) &&
                             (!model.supply || model.supply->is_consistent());
  if (model.networks.taxel_count() != model.array.taxel_count() || !is_consistent) {
    return bad_input("the model's networks do not fit its array, or hold values out of range");
  }
  const std::vector<double> typical = typical_siemens(model.networks);
  Result<compensation::Compensator> compensator =
      compensation::Compensator::create(model.array, {typical, model.networks.unloaded.offset_siemens});
  if (!compensator) return compensator.error();
  return Pipeline(model, std::move(*compensator));
}

Pipeline::Pipeline(const Model& model, compensation::Compensator compensator)
    : conditioner_(model.array, model.supply),
      compensator_(std::move(compensator)),
      monitor_(model.array, model.networks.unloaded.offset_siemens),
      drift_({model.array.rows, model.array.cols}, unloaded(model.networks)),
      tare_judge_(std::make_unique<TareJudge>(model.networks.unloaded)),
      fusion_(model.networks) {
  if (model.memory) memory_.emplace(*model.memory, model.networks.taxel_count());
}

void Pipeline::process(const RawFrame& raw, ForceFrame& force) noexcept {
  conditioner_.process(raw, conditioned_);           // unit 2: validated, supply divided out
  compensator_.process(conditioned_, conductance_);  // unit 3: crosstalk solved
  if (monitor_.observe(conditioned_, conductance_)) {
    compensator_.set_faults(monitor_.faults());
    compensator_.process(conditioned_, conductance_);
  }
  if (drift_.observe(conductance_)) tare_judge_->end(drift_, conductance_, fusion_, force);
  drift_.correct(conductance_);                                   // zero kept at zero
  fusion_.process(conductance_, force);                           // unit 4: material and temperature fused to newtons
  if (memory_) memory_->process(force, fusion_.noise_newtons());  // and what the material remembers
}

Pipeline::Pipeline(Pipeline&&) noexcept = default;
Pipeline& Pipeline::operator=(Pipeline&&) noexcept = default;
Pipeline::~Pipeline() = default;

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

}  // namespace dermis::pipeline
