// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>
#include <vector>

#include "dermis/learn/calibration/circuit_fit.hpp"
#include "learn/calibration/circuit_fit/resistance_fit.hpp"

namespace dermis::learn::calibration {

/// Says which kind was chosen, which ones the frames do not distinguish from it, and which presses would.
[[nodiscard]] std::vector<std::string> describe_choice(const ArrayDescription& array,
                                                       const std::vector<CircuitCandidate>& candidates,
                                                       const std::vector<PressPair>& discriminating_presses);

/// "the ADC does not resolve "divider, idle rows floating" under these loads (...)".
[[nodiscard]] std::string describe_unresolved(const std::string& circuit, double noise_share);

/// Gives the resistances with their standard errors, and names those that the frames cannot determine.
[[nodiscard]] std::vector<std::string> describe_fit(const ResistanceFit& fit);

}  // namespace dermis::learn::calibration
