// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cmath>
#include <cstddef>

#include "dermis/paper/network_bank.hpp"

namespace dermis::paper {

/// The factors that take the bias from the moments of Adam at step t (Kingma and Ba, 2015, algorithm 1), and the rate.
struct AdamScales {
  float rate;                 ///< rate / (1 - first_decay^t)
  float second_scale = 1.0F;  ///< 1 / (1 - second_decay^t)
};

[[nodiscard]] inline AdamScales adam_scales(const BankStep& step, std::size_t t) {
  const auto unbias = [&](float decay) { return 1.0 / (1.0 - std::pow(double{decay}, static_cast<double>(t))); };
  return {static_cast<float>(double{step.rate} * unbias(step.first_decay)),
          static_cast<float>(unbias(step.second_decay))};
}

}  // namespace dermis::paper
