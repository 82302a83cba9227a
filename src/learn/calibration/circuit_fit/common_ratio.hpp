// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <vector>

#include "dermis/touch/frames/result.hpp"
#include "learn/calibration/circuit_fit/circuit_frames.hpp"
#include "learn/calibration/circuit_fit/estimate.hpp"
#include "learn/calibration/circuit_fit/inverted_frame.hpp"
#include "learn/calibration/circuit_fit/line_parameters.hpp"
#include "learn/calibration/circuit_fit/rubber.hpp"

namespace dermis::learn::calibration {

/// A circuit whose unknown resistances are alike: one number, drivers over loads, stands for all of them.
struct CommonRatio {
  double ratio = 0.0;
  ArrayDescription array;  ///< With numbers for all resistances.
  Rubber rubber;
  Scatter scatter;
  InvertedFrames inverted;  ///< The frames that it was fitted to.
  double misfit = 0.0;      ///< Sum of squares that is left of the frames, see judge_frames().
};

/// The ratio with the least residual over the frames, with all laws fitted anew for each ratio. The whole range is
/// searched, so no start has to be near. Errors: a circuit that cannot be inverted, or not at most of the frames.
[[nodiscard]] Result<CommonRatio> fit_common_ratio(const LineParameters& lines,
                                                   const std::vector<const CircuitFrame*>& frames,
                                                   const Rubber& unknown);

}  // namespace dermis::learn::calibration
