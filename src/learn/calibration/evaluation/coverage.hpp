// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <span>

#include "dermis/learn/calibration/evaluation.hpp"

namespace dermis::learn::calibration {

inline constexpr double kSigmas68 = 0.99446;  // a normal error is within so many standard deviations
inline constexpr double kSigmas95 = 1.95996;  // with 68 % probability, and with 95 %

[[nodiscard]] Coverage coverage_of(std::span<const JudgedTaxel> taxels);

}  // namespace dermis::learn::calibration
