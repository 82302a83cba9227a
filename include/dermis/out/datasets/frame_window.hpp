// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "dermis/touch/frames/frames.hpp"

namespace dermis::out::datasets {

/// The last frames of one array at the steps of an episode. It knows their times; the caller keeps the frames in slots.
/// Not thread-safe.
class FrameWindow {
 public:
  struct Held {
    std::size_t slot = 0;
    Nanos time{};
  };

  /// `length`: most frames of a window, >= 1.
  explicit FrameWindow(std::size_t length) : length_(length) {}

  /// A frame that waits for its step: the slot to put it into. A slot comes again once its frame can be in no window.
  /// Empty for a frame earlier than the one before, which is in no window.
  [[nodiscard]] std::optional<std::size_t> add(Nanos time);

  /// Moves on to a step: the window holds the last frames of that time and earlier. `time` rises.
  void step(Nanos time);

  /// Says when the next step is. Frames that its window will not hold give their slots back.
  void await(Nanos next);

  /// The window, from its oldest frame to its newest.
  [[nodiscard]] const std::deque<Held>& held() const noexcept { return held_; }
  /// So many of the newest were not in the window of the step before.
  [[nodiscard]] std::size_t fresh() const noexcept { return std::min(came_, length_); }
  /// So many came since the step before, in the window or not.
  [[nodiscard]] std::size_t came() const noexcept { return came_; }
  /// Frames that came and are in no window: more came between two steps than it holds, or they were too late.
  [[nodiscard]] std::uint64_t missed() const noexcept { return missed_; }

 private:
  std::size_t length_;
  std::deque<Held> waiting_;
  std::deque<Held> held_;
  std::vector<std::size_t> free_;
  std::size_t slots_ = 0;
  std::size_t came_ = 0;
  std::size_t skipped_ = 0;  ///< They came since the last step and gave their slots back.
  std::uint64_t missed_ = 0;
  std::optional<Nanos> newest_;
};

}  // namespace dermis::out::datasets
