// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "dermis/learn/calibration/evaluation.hpp"
#include "dermis/learn/calibration/sample_database.hpp"
#include "learn/calibration/evaluation/estimator_row.hpp"
#include "learn/calibration/evaluation/noise_bound.hpp"

namespace dermis::learn::calibration {

/// Compares dermis with the bound on every so many of the labelled frames.
class BoundCollector {
 public:
  BoundCollector(const touch::pipeline::Model& model, std::size_t labelled_frames);

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

}  // namespace dermis::learn::calibration
