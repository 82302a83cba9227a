// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <vector>

#include "dermis/learn/calibration/circuit_fit.hpp"
#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/result.hpp"
#include "learn/calibration/circuit_fit/circuit_frames.hpp"

namespace dermis::learn::calibration {

/// The kind of circuit that explains the frames best.
struct CircuitChoice {
  ArrayDescription array;                         ///< Has that kind; resistances that are not given are kFitOhm.
  std::vector<CircuitCandidate> candidates;       ///< The best first.
  std::vector<PressPair> discriminating_presses;  ///< Where some of them are indistinguishable.
};

/// Fits every kind that the ADC resolves with one resistance for all drivers and one for all loads, and compares their
/// residuals. Kinds with nearly the same residual are fitted again with a resistance for each line. All have the same
/// laws for the taxels. Errors: no kind explains the frames.
[[nodiscard]] Result<CircuitChoice> choose_circuit(const ArrayDescription& array, const CircuitFrames& frames);

}  // namespace dermis::learn::calibration
