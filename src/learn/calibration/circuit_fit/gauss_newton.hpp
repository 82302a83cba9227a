// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "dermis/touch/frames/result.hpp"
#include "learn/calibration/circuit_fit/circuit_frames.hpp"
#include "learn/calibration/circuit_fit/estimate.hpp"
#include "learn/calibration/circuit_fit/inverted_frame.hpp"
#include "learn/calibration/circuit_fit/line_parameters.hpp"

namespace dermis::learn::calibration {

/// The result of a Gauss-Newton step.
struct Iteration {
  Estimate estimate;
  Eigen::MatrixXd covariance;      ///< For the parameters, then for the common terms of the pressed laws.
  double step = 0.0;               ///< The largest of a parameter, in its standard errors.
  bool has_idle_readings = false;  ///< Large enough to be evidence.
};

/// Gauss-Newton with the taxels' laws eliminated (variable projection), until a step is smaller than `enough` standard
/// errors. Errors: a circuit that cannot be inverted.
[[nodiscard]] Result<Iteration> iterate(const LineParameters& lines, const std::vector<const CircuitFrame*>& frames,
                                        const Estimate& start, double enough);

/// The laws in a circuit whose resistances are known, of frames that are inverted already.
[[nodiscard]] Iteration fit_laws(const LineParameters& known, const InvertedFrames& inverted,
                                 const std::vector<const CircuitFrame*>& frames, const Estimate& start);

}  // namespace dermis::learn::calibration
