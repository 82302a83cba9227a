// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/evaluation/estimator_row.hpp"

#include <optional>
#include <utility>

#include "dermis/touch/preprocessing/conditioner.hpp"

namespace dermis::learn::calibration {

EstimatorRow::EstimatorRow(const touch::pipeline::Model& model, touch::pipeline::Pipeline pipeline,
                           FurtherEstimator* further, double judged_from_n)
    : model_(model),
      pipeline_(std::move(pipeline)),
      further_(further),
      judged_from_n_(judged_from_n),
      reading_(model.array.taxel_count()) {
  names_.emplace_back("dermis");
  for (const touch::fusion::LookUpTables& tables : model.baselines) names_.push_back(tables.name);
  if (further != nullptr) names_.push_back(further->name());
  newtons_.assign(names_.size(), std::vector<float>(model.array.taxel_count()));
}

bool EstimatorRow::run(const RawFrame& raw) {
  pipeline_.process(raw, force_);
  if (has(force_.status, FrameStatus::rejected)) return false;
  newtons_[0] = force_.newtons;
  const std::optional<double> celsius = pipeline_.conditioned().temperature_celsius;
  touch::preprocessing::bare_readings(model_.array, raw, reading_);
  for (std::size_t k = 0; k < model_.baselines.size(); ++k) {
    const touch::fusion::LookUpTables& tables = model_.baselines[k];
    const bool bare = tables.signal == touch::fusion::LookUpSignal::reading;
    tables.estimate(bare ? reading_ : pipeline_.conductance().siemens, celsius, newtons_[k + 1]);
  }
  if (further_ != nullptr) {
    further_->estimate(pipeline_.conditioned().ratio, celsius, newtons_.back());
  }
  return true;
}

}  // namespace dermis::learn::calibration
