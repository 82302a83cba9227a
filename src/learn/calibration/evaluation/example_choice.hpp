// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "dermis/learn/calibration/evaluation.hpp"
#include "dermis/learn/calibration/sample_database.hpp"
#include "learn/calibration/evaluation/estimator_row.hpp"

namespace dermis::learn::calibration {

/// Frames for pictures: the first ones that press several taxels, or else the first ones that press any.
class ExampleChoice {
 public:
  void offer(std::size_t frame, const Sample& truth, const EstimatorRow& row);

  [[nodiscard]] std::vector<TactileExample> chosen() && { return std::move(rich_.empty() ? plain_ : rich_); }

 private:
  std::vector<TactileExample> rich_;
  std::vector<TactileExample> plain_;
};

}  // namespace dermis::learn::calibration
