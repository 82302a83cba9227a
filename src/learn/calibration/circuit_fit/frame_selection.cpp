// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/circuit_fit/frame_selection.hpp"

#include <algorithm>
#include <cstdint>

#include "dermis/touch/frames/random.hpp"

namespace dermis::learn::calibration {
namespace {

constexpr double kMostWork = 2e8;          // frames x taxels x inversions of one pass
constexpr double kSlowness = 20.0;         // of the inversion of floating rows, against that of grounded ones
constexpr double kMostWorkOfChoice = 3e5;  // frames x taxels
constexpr double kMostWorkOfSlowChoice = 3e4;
constexpr std::uint64_t kSelectionSeed = 1;

bool presses_several(const CircuitFrame& frame) {
  return std::count_if(frame.newtons.begin(), frame.newtons.end(), [](float newtons) { return newtons > 0.0F; }) > 1;
}

double share(std::size_t places, std::size_t frames) {
  return frames == 0 ? 0.0 : static_cast<double>(places) / static_cast<double>(frames);
}

}  // namespace

std::size_t affordable_frames(const LineParameters& lines) {
  const auto cost = static_cast<double>(lines.array().taxel_count() * static_cast<std::size_t>(lines.count() + 4));
  const bool is_slow = is_inverted_slowly(lines.array());
  return static_cast<std::size_t>(kMostWork / cost / (is_slow ? kSlowness : 1.0));
}

std::size_t affordable_frames_of_choice(std::size_t taxels, bool is_slow) {
  const double work = is_slow ? kMostWorkOfSlowChoice : kMostWorkOfChoice;
  return static_cast<std::size_t>(work / static_cast<double>(taxels));
}

std::size_t few_frames(std::size_t taxels) {
  constexpr std::size_t kFewest = 24;
  constexpr std::size_t kFew = 60;
  return std::clamp(affordable_frames_of_choice(taxels, true), kFewest, kFew);
}

std::vector<const CircuitFrame*> select_frames(const CircuitFrames& frames, std::size_t most) {
  const auto several =
      static_cast<std::size_t>(std::count_if(frames.frames.begin(), frames.frames.end(), presses_several));
  const std::size_t others = frames.frames.size() - several;
  const std::size_t for_several = std::min(several, std::max(most / 2, most - std::min(most, others)));
  const double share_of_several = share(for_several, several);
  const double share_of_others = share(most - for_several, others);
  std::vector<const CircuitFrame*> selected;
  for (std::size_t k = 0; k < frames.frames.size(); ++k) {
    const double most_of_lot = presses_several(frames.frames[k]) ? share_of_several : share_of_others;
    if (Random::stream(kSelectionSeed, k).uniform() < most_of_lot) selected.push_back(&frames.frames[k]);
  }
  return selected;
}

}  // namespace dermis::learn::calibration
