// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <vector>

#include "learn/calibration/uncertainty/error_budget.hpp"

namespace dermis::learn::calibration {

/// Minus the logarithm of the likelihood of the noise; a load beyond three standard deviations counts as three.
[[nodiscard]] double surprise(const std::vector<JudgedLoad>& loads, double supply_noise);

/// The relative errors at the knots that make the errors of the loads likeliest. They are scaled until as many loads
/// are within their standard deviations as in a normal distribution. Few loads have the same relative error at all
/// forces.
[[nodiscard]] VarianceProfile likeliest_profile(const std::vector<JudgedLoad>& loads, double supply_noise);

}  // namespace dermis::learn::calibration
