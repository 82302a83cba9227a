// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <vector>

#include "learn/calibration/circuit_fit/estimate.hpp"
#include "learn/calibration/circuit_fit/line_parameters.hpp"
#include "learn/calibration/circuit_fit/normal_equations.hpp"
#include "learn/calibration/circuit_fit/pressed_readings.hpp"
#include "learn/calibration/circuit_fit/step.hpp"

namespace dermis::learn::calibration {

/// The scatter by what a step leaves of the readings. `estimate`: after the step, with the scatter before it.
[[nodiscard]] Scatter learn_scatter(const LineParameters& lines, const Estimate& estimate, const Step& step,
                                    const Elimination& idle, const Elimination& pressed,
                                    const std::vector<PressedReading>& readings);

}  // namespace dermis::learn::calibration
