// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <vector>

#include "dermis/learn/calibration/circuit_fit.hpp"
#include "learn/calibration/circuit_fit/circuit_frames.hpp"
#include "learn/calibration/circuit_fit/rubber.hpp"

namespace dermis::learn::calibration {

/// Conductances of all taxels while a pair is pressed, by their laws at the middle of the temperatures [taxels].
[[nodiscard]] std::vector<double> siemens_under(const Rubber& rubber, const PressPair& pair);

/// The heaviest known load of every taxel with a pressed law in `rubber`; 0: none [N].
[[nodiscard]] std::vector<double> heaviest_loads(const Rubber& rubber, const CircuitFrames& frames);

/// The taxels are no neighbours: rubber spreads a load to them.
[[nodiscard]] bool are_apart(std::size_t cols, std::size_t a, std::size_t b);

/// The noise of a typical pressed frame, over the supply. Presses that are asked for are kept like the recorded ones;
/// unloaded frames are means of more readings.
[[nodiscard]] double noise_of_presses(const CircuitFrames& frames);

}  // namespace dermis::learn::calibration
