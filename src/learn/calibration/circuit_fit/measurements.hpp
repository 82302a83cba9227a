// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <vector>

#include "dermis/touch/frames/result.hpp"
#include "learn/calibration/circuit_fit/circuit_frames.hpp"
#include "learn/calibration/circuit_fit/estimate.hpp"
#include "learn/calibration/circuit_fit/inverted_frame.hpp"
#include "learn/calibration/circuit_fit/line_parameters.hpp"
#include "learn/calibration/circuit_fit/normal_equations.hpp"
#include "learn/calibration/circuit_fit/pressed_readings.hpp"

namespace dermis::learn::calibration {

/// The measurements of the frames as one circuit explains them.
struct Measurements {
  NormalEquations idle;  ///< Columns: parameters, conductance over the reference; weighted by the described noise.
  std::vector<PressedReading> pressed;
  std::size_t lost_frames = 0;  ///< That the circuit cannot give.
};

/// Inverts the frames on all cores. Errors: a circuit that cannot be inverted.
[[nodiscard]] Result<Measurements> measure(const LineParameters& lines, const std::vector<const CircuitFrame*>& frames,
                                           const Estimate& estimate);

/// The same of frames that are inverted already, in a circuit without parameters.
[[nodiscard]] Measurements measure(const InvertedFrames& inverted, const std::vector<const CircuitFrame*>& frames,
                                   const Estimate& estimate);

}  // namespace dermis::learn::calibration
