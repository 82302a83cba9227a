// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <vector>

#include "dermis/learn/calibration/circuit_fit.hpp"
#include "learn/calibration/circuit_fit/circuit_frames.hpp"
#include "learn/calibration/circuit_fit/common_ratio.hpp"

namespace dermis::learn::calibration {

/// The five pairs of taxels whose readings differ most between the circuits when both are pressed with the heaviest
/// load that both have had. A pair counts by the least distance from the first circuit to another, in the noise of a
/// typical pressed frame. Fewer where there are no more pairs; none where all together would not distinguish the
/// circuits. `circuits`: at least two.
[[nodiscard]] std::vector<PressPair> discriminating_presses(const std::vector<const CommonRatio*>& circuits,
                                                            const CircuitFrames& frames, double sure_square);

}  // namespace dermis::learn::calibration
