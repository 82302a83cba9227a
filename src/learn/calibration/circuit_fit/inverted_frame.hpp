// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/result.hpp"
#include "learn/calibration/circuit_fit/circuit_frames.hpp"
#include "learn/calibration/circuit_fit/rubber.hpp"
#include "learn/calibration/circuit_fit/sloped_inversion.hpp"

namespace dermis::learn::calibration {

/// A frame's taxels in one circuit.
struct InvertedFrame {
  std::vector<double> siemens;
  std::vector<double> sigma_siemens;  ///< Infinite: a reading without evidence.
  Eigen::MatrixXd slopes;             ///< d siemens / d parameter [taxels, parameters or 0].

  [[nodiscard]] Eigen::VectorXd slopes_of(std::size_t taxel) const {
    if (slopes.cols() == 0) return {};  // a matrix without columns has no memory to point a row at
    return slopes.row(static_cast<Eigen::Index>(taxel)).transpose();
  }
};

/// Empty: the circuit cannot give this frame, and the inversion has forgotten it. Where slopes are wanted, they and the
/// pressed taxels are taken with the idle ones at their laws. Derivatives at noisy readings would follow the noise, and
/// the fit would reduce the noise by making all conductances small.
[[nodiscard]] std::optional<InvertedFrame> invert_frame(SlopedInversion& inversion, const CircuitFrame& frame,
                                                        const Rubber& rubber);

/// The same of many frames, on all cores, where all resistances of `array` are known: no law is needed. Errors: a
/// circuit that cannot be inverted.
using InvertedFrames = std::vector<std::optional<InvertedFrame>>;
[[nodiscard]] Result<InvertedFrames> invert_frames(const ArrayDescription& array,
                                                   const std::vector<const CircuitFrame*>& frames);

}  // namespace dermis::learn::calibration
