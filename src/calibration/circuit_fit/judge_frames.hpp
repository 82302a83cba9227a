// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <vector>

#include "calibration/circuit_fit/circuit_frames.hpp"
#include "calibration/circuit_fit/estimate.hpp"
#include "calibration/circuit_fit/inverted_frame.hpp"
#include "calibration/circuit_fit/rubber.hpp"
#include "dermis/core/array_description.hpp"

namespace dermis::calibration {

/// What a circuit leaves unexplained.
struct FrameMisfit {
  double square = 0.0;  ///< Sum over its readings, in their variances; no single reading decides.
  double readings = 0.0;

  FrameMisfit& operator+=(const FrameMisfit& other) {
    square += other.square;
    readings += other.readings;
    return *this;
  }
};

/// Idle taxels against their unloaded conductance, pressed ones against their laws, over all frames. `inverted`: of
/// them in `array`, whose resistances are all known.
[[nodiscard]] FrameMisfit judge_frames(const ArrayDescription& array, const Rubber& rubber, const Scatter& scatter,
                                       const InvertedFrames& inverted, const std::vector<const CircuitFrame*>& frames);

}  // namespace dermis::calibration
