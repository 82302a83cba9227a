// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <vector>

#include "dermis/learn/calibration/calibration_plan.hpp"

namespace dermis::learn::calibration {

struct PlannedPress {
  std::size_t taxel = 0;
  double weight_n = 0.0;
};

/// The presses of a plan in an order whose every beginning covers places and weights evenly, so that a person may stop
/// at any time. A round presses each taxel once, the next one always farthest from those before, with weights in turn.
/// A few presses of a weight follow each other, as changing it takes time. `cols`: of the array.
[[nodiscard]] std::vector<PlannedPress> spread_presses(const CalibrationPlan& plan, std::size_t cols);

}  // namespace dermis::learn::calibration
