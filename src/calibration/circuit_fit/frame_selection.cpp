// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "calibration/circuit_fit/frame_selection.hpp"

#include <cstdint>

#include "dermis/core/random.hpp"

namespace dermis::calibration {
namespace {

constexpr double kMostWork = 2e8;          // frames x taxels x inversions of one pass
constexpr double kNewtonSlowness = 100.0;  // of an inversion by Newton's method, against the fixed point
constexpr std::uint64_t kSelectionSeed = 1;

}  // namespace

std::size_t affordable_frames(const LineParameters& lines) {
  const Readout& readout = lines.array().readout;
  const auto cost = static_cast<double>(lines.array().taxel_count() * static_cast<std::size_t>(lines.count() + 4));
  const bool is_slow = readout.circuit == Circuit::divider && readout.idle_rows == IdleRows::floating;
  return static_cast<std::size_t>(kMostWork / cost / (is_slow ? kNewtonSlowness : 1.0));
}

std::vector<const CircuitFrame*> select_frames(const CircuitFrames& frames, std::size_t most) {
  const double share = static_cast<double>(most) / static_cast<double>(frames.frames.size());
  std::vector<const CircuitFrame*> selected;
  for (std::size_t k = 0; k < frames.frames.size(); ++k) {
    const bool is_drawn = share >= 1.0 || Random::stream(kSelectionSeed, k).uniform() < share;
    if (is_drawn) selected.push_back(&frames.frames[k]);
  }
  return selected;
}

}  // namespace dermis::calibration
