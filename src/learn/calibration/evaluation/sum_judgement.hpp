// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <vector>

#include "dermis/learn/calibration/evaluation.hpp"
#include "dermis/learn/calibration/sample_database.hpp"

namespace dermis::learn::calibration {

/// Sums over the array beside what lies on it, of frames whose loads are known throughout.
class SumJudgement {
 public:
  void add(const Sample& truth, const ForceFrame& force);
  [[nodiscard]] SumErrors errors() const;

 private:
  struct Judged {
    double true_newtons;
    double newtons;
    double sigma_newtons;
  };

  std::vector<Judged> touched_;
  std::vector<Judged> untouched_;
};

}  // namespace dermis::learn::calibration
