// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/evaluation/bound_collector.hpp"

#include <algorithm>
#include <cmath>

namespace dermis::learn::calibration {

BoundCollector::BoundCollector(const touch::pipeline::Model& model, std::size_t labelled_frames)
    : bound_(NoiseBound::create(model)) {
  if (bound_) stride_ = std::max<std::size_t>(labelled_frames / bound_->affordable_frames(), 1);
}

void BoundCollector::offer(const Sample& truth, const EstimatorRow& row) {
  if (!bound_ || offered_++ % stride_ != 0) return;
  const auto is_judged = [&](float newtons) { return newtons >= row.judged_from_n(); };
  if (std::none_of(truth.known_newtons.begin(), truth.known_newtons.end(), is_judged)) return;
  const std::vector<float> bound =
      bound_->newtons(row.pipeline().conductance(), row.pipeline().conditioned().sigma_ratio);
  ++frames_;
  for (std::size_t taxel = 0; taxel < bound.size(); ++taxel) {
    const double newtons = truth.known_newtons[taxel];
    if (!(newtons >= row.judged_from_n()) || !std::isfinite(bound[taxel])) continue;
    const double error = static_cast<double>(row.force().newtons[taxel]) - newtons;
    bounds_.push_back(static_cast<double>(bound[taxel]) / newtons);
    errors_.push_back(std::abs(error) / newtons);
  }
}

BoundComparison BoundCollector::comparison() const {
  if (bounds_.empty()) return {};
  double square = 0.0;
  for (std::size_t k = 0; k < bounds_.size(); ++k) square += std::pow(errors_[k] / bounds_[k], 2);
  constexpr double kMedianOfNormal = 0.67449;
  return {frames_, bounds_.size(), *summarise(bounds_).median, *summarise(errors_).median / kMedianOfNormal,
          std::sqrt(square / static_cast<double>(bounds_.size()))};
}

}  // namespace dermis::learn::calibration
