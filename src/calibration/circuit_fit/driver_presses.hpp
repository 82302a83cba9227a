// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <Eigen/Core>
#include <vector>

#include "calibration/circuit_fit/circuit_frames.hpp"
#include "calibration/circuit_fit/estimate.hpp"
#include "calibration/circuit_fit/line_parameters.hpp"
#include "dermis/calibration/circuit_fit.hpp"

namespace dermis::calibration {

/// The five pairs of taxels of one driven line each that make the drivers surest, one after the other, when both are
/// pressed with the heaviest load they have had: each takes from the other what their driver loses. Only those that
/// tell more of their driver than all frames did. `covariance`: of the drivers among the parameters.
[[nodiscard]] std::vector<PressPair> driver_presses(const LineParameters& lines, const Estimate& fitted,
                                                    Eigen::MatrixXd covariance, const CircuitFrames& frames);

}  // namespace dermis::calibration
