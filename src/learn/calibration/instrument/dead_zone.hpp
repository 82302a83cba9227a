// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <optional>
#include <string>

#include "learn/calibration/circuit_fit/circuit_frames.hpp"

namespace dermis::learn::calibration {

/// "below 1.5 N the readings tell nothing: 96 of 100 presses with 0.7 N or less leave them as they were; ...". Empty:
/// the lightest presses of single taxels raise most readings.
[[nodiscard]] std::optional<std::string> describe_dead_zone(const CircuitFrames& frames);

}  // namespace dermis::learn::calibration
