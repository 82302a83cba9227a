// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <vector>

#include "learn/calibration/circuit_fit/circuit_frames.hpp"
#include "learn/calibration/circuit_fit/line_parameters.hpp"

namespace dermis::learn::calibration {

/// As many frames as the time allows: an inversion for each parameter and frame.
[[nodiscard]] std::size_t affordable_frames(const LineParameters& lines);

/// The same where kinds of circuits are compared. `is_slow`: one of them is inverted slowly.
[[nodiscard]] std::size_t affordable_frames_of_choice(std::size_t taxels, bool is_slow);

/// The fewest frames with which a circuit is tried: fewer on large arrays.
[[nodiscard]] std::size_t few_frames(std::size_t taxels);

/// About `most` frames of all, spread at random: neighbours in time may press the same taxels. At least half of the
/// places are for frames with several pressed taxels, which depend more on the circuit.
[[nodiscard]] std::vector<const CircuitFrame*> select_frames(const CircuitFrames& frames, std::size_t most);

}  // namespace dermis::learn::calibration
