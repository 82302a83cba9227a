// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <vector>

#include "dermis/learn/calibration/circuit_fit.hpp"
#include "learn/calibration/guided/held_out_presses.hpp"

namespace dermis::learn::calibration {

/// Eight pairs of taxels of a row, spread over the array, each with the heaviest weight that both have had alone. They
/// tell whether circuit and ADC are as described, which single presses hide (fit_instrument()). None where there are
/// fewer than eight such pairs, fewer than three presses for each of them, or no circuit.
[[nodiscard]] std::vector<PressPair> proof_presses(const ArrayDescription& array, const GuidedPresses& presses);

}  // namespace dermis::learn::calibration
