// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <vector>

#include "calibration/circuit_fit/circuit_frames.hpp"
#include "calibration/circuit_fit/estimate.hpp"
#include "calibration/circuit_fit/rubber.hpp"
#include "dermis/core/array_description.hpp"

namespace dermis::calibration {

/// What a circuit leaves unexplained of a frame.
struct FrameMisfit {
  double square = 0.0;  ///< Sum over its readings, in their variances; no single reading decides.
  double readings = 0.0;
};

/// Idle taxels against their unloaded conductance, pressed ones against their laws. `array`: all resistances known.
[[nodiscard]] std::vector<FrameMisfit> judge_frames(const ArrayDescription& array, const Rubber& rubber,
                                                    const Scatter& scatter,
                                                    const std::vector<const CircuitFrame*>& frames);

[[nodiscard]] FrameMisfit sum(const std::vector<FrameMisfit>& frames);

}  // namespace dermis::calibration
