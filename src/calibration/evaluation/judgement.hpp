// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "calibration/evaluation/estimator_row.hpp"
#include "dermis/calibration/evaluation.hpp"
#include "dermis/calibration/sample_database.hpp"

namespace dermis::calibration {

/// What every estimator made of the loads, gathered while the frames go by.
struct Judgement {
  explicit Judgement(std::size_t estimators) : ghost_n(estimators) {}

  /// One labelled frame that `row` has run.
  void add(std::size_t frame, const RawFrame& raw, const Sample& truth, const EstimatorRow& row);

  [[nodiscard]] EstimatorResult result(std::size_t estimator, std::string name) const;

  std::vector<JudgedTaxel> taxels;
  std::vector<JudgedTotal> totals;
  std::vector<std::vector<double>> ghost_n;  ///< Forces on unloaded taxels [estimators].
};

}  // namespace dermis::calibration
