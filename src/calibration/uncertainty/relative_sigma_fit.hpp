// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <vector>

#include "calibration/uncertainty/error_budget.hpp"

namespace dermis::calibration {

/// Minus the logarithm of the likelihood of the noise; a load beyond three standard deviations counts as three.
[[nodiscard]] double surprise(const std::vector<JudgedLoad>& loads, double supply_noise);

/// The relative errors at the knots that make the errors of the loads likeliest, scaled until as many are within their
/// standard deviations as a normal distribution has within. Few loads have the same relative error at all forces.
[[nodiscard]] VarianceProfile likeliest_profile(const std::vector<JudgedLoad>& loads, double supply_noise);

}  // namespace dermis::calibration
