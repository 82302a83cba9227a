// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <Eigen/Core>
#include <vector>

#include "dermis/learn/calibration/circuit_fit.hpp"
#include "learn/calibration/circuit_fit/circuit_frames.hpp"
#include "learn/calibration/circuit_fit/estimate.hpp"
#include "learn/calibration/circuit_fit/line_parameters.hpp"

namespace dermis::learn::calibration {

/// The five pairs of taxels, each on one driven line, that make the drivers surest when both are pressed. They are
/// chosen one after the other, with the heaviest load that both have had. Each taxel of a pair takes from the other the
/// voltage that their driver loses. Only pairs with more information on their driver than in all frames count.
/// `covariance`: of the drivers among the parameters.
[[nodiscard]] std::vector<PressPair> driver_presses(const LineParameters& lines, const Estimate& fitted,
                                                    Eigen::MatrixXd covariance, const CircuitFrames& frames);

}  // namespace dermis::learn::calibration
