// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>
#include <vector>

#include "dermis/learn/calibration/evaluation.hpp"
#include "dermis/touch/pipeline/model.hpp"
#include "dermis/touch/pipeline/pipeline.hpp"

namespace dermis::learn::calibration {

/// All estimators on one frame: dermis, the baselines of the model, a further estimator where there is one.
class EstimatorRow {
 public:
  /// `model` and `further` (nullptr: none) are to outlive it; `pipeline` is that of the model.
  EstimatorRow(const touch::pipeline::Model& model, touch::pipeline::Pipeline pipeline, FurtherEstimator* further,
               double judged_from_n);

  /// Returns false where the frame is rejected.
  bool run(const RawFrame& raw);

  [[nodiscard]] const ArrayDescription& array() const noexcept { return model_.array; }
  /// True force from which on taxels are judged [N].
  [[nodiscard]] double judged_from_n() const noexcept { return judged_from_n_; }
  [[nodiscard]] const std::vector<std::string>& names() const noexcept { return names_; }
  /// Estimates for the last frame, [estimators][taxels].
  [[nodiscard]] const std::vector<std::vector<float>>& newtons() const noexcept { return newtons_; }
  /// The frame of dermis.
  [[nodiscard]] const ForceFrame& force() const noexcept { return force_; }
  [[nodiscard]] const touch::pipeline::Pipeline& pipeline() const noexcept { return pipeline_; }
  /// counts / full scale [taxels].
  [[nodiscard]] const std::vector<double>& reading() const noexcept { return reading_; }

 private:
  const touch::pipeline::Model& model_;
  touch::pipeline::Pipeline pipeline_;
  FurtherEstimator* further_;
  double judged_from_n_;
  ForceFrame force_;
  std::vector<std::string> names_;
  std::vector<double> reading_;
  std::vector<std::vector<float>> newtons_;
};

}  // namespace dermis::learn::calibration
