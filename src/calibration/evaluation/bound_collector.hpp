// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "calibration/evaluation/estimator_row.hpp"
#include "calibration/evaluation/noise_bound.hpp"
#include "dermis/calibration/evaluation.hpp"
#include "dermis/calibration/sample_database.hpp"

namespace dermis::calibration {

/// Compares dermis with the bound on every so many of the labelled frames.
class BoundCollector {
 public:
  BoundCollector(const pipeline::Model& model, std::size_t labelled_frames);

  /// To be called for every labelled frame that was accepted.
  void offer(const Sample& truth, const EstimatorRow& row);

  [[nodiscard]] BoundComparison comparison() const;

 private:
  std::optional<NoiseBound> bound_;
  std::size_t stride_ = 1;
  std::size_t offered_ = 0;
  std::size_t frames_ = 0;
  std::vector<double> bounds_;  // over the true force
  std::vector<double> errors_;  // over the true force
};

}  // namespace dermis::calibration
