// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <vector>

#include "learn/calibration/circuit_fit/circuit_frames.hpp"

namespace dermis::learn::calibration {

/// The pressed taxels of a frame, and their force in all.
struct Press {
  const CircuitFrame* frame = nullptr;
  std::vector<std::size_t> taxels;
  double newtons = 0.0;
};

/// Frames by what they press. Each kind is sorted by place, then by force, so that the order of the recording is of no
/// account.
struct Presses {
  std::vector<Press> single;   ///< One taxel alone.
  std::vector<Press> several;  ///< Up to six taxels that were all pressed alone, too, and no lighter.
};

/// At most so many of each kind, evenly over places, and over the forces in each. Those on several taxels are thinned
/// until a law can be learned for each of their taxels; single presses of these come first.
[[nodiscard]] Presses sort_presses(const CircuitFrames& frames, std::size_t most);

/// The frames of all presses: the single ones, then those of several.
[[nodiscard]] std::vector<const CircuitFrame*> frames_of(const Presses& presses);

}  // namespace dermis::learn::calibration
