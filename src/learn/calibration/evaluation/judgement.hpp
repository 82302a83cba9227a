// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "dermis/learn/calibration/evaluation.hpp"
#include "dermis/learn/calibration/sample_database.hpp"
#include "learn/calibration/evaluation/estimator_row.hpp"
#include "learn/calibration/evaluation/touch_clock.hpp"

namespace dermis::learn::calibration {

/// Forces that estimators gave on taxels whose load had gone [N], in bins of the time since.
class ReleaseGhosts {
 public:
  void add(double seconds, const std::vector<std::vector<float>>& newtons, std::size_t taxel);
  [[nodiscard]] std::vector<ReleaseBin> bins() const;

 private:
  std::map<std::size_t, std::vector<std::vector<double>>> newtons_;  // of each bin [estimators]
};

/// The errors of every estimator on the loads, gathered while the frames go by.
struct Judgement {
  Judgement(std::size_t estimators, std::size_t taxels) : ghost_n(estimators), clocks(taxels) {}

  /// One labelled frame that `row` has run.
  void add(std::size_t frame, const RawFrame& raw, const Sample& truth, const EstimatorRow& row);

  [[nodiscard]] EstimatorResult result(std::size_t estimator, std::string name) const;

  std::vector<JudgedTaxel> taxels;
  std::vector<JudgedTotal> totals;
  std::vector<std::vector<double>> ghost_n;  ///< Forces on unloaded taxels [estimators].
  std::vector<PlaceClock> clocks;            ///< [taxels]
  PlaceClock total_clock;
  ReleaseGhosts after_release;
};

}  // namespace dermis::learn::calibration
