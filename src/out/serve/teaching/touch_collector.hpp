// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "dermis/learn/recognition/touch_finder.hpp"
#include "dermis/touch/frames/contacts.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "out/serve/recognition/frame_resampler.hpp"

namespace dermis::out::serve {

/// A touch with a little of what was before and after it.
struct CollectedTouch {
  std::vector<float> frames{};  ///< [frames, taxels], newtons at TouchCollector::kRateHz.
  std::size_t first = 0;        ///< Of the frames that are the touch,
  std::size_t last = 0;         ///< both within.
};

/// Cuts the touches out of the stream of one array. Not thread-safe.
class TouchCollector {
 public:
  static constexpr double kRateHz = 50.0;
  static constexpr std::size_t kMostFrames = 200;  ///< Longest touch; longer ones do not count.

  explicit TouchCollector(std::size_t taxels);

  /// Gives a touch once it is over; one that goes on when the stream begins is none. `report`: of the frame.
  [[nodiscard]] std::optional<CollectedTouch> next(const ForceFrame& force, const ContactReport& report);

  [[nodiscard]] bool is_touched() const noexcept { return finder_.is_touched(); }

 private:
  void keep(std::span<const float> newtons);
  [[nodiscard]] std::optional<CollectedTouch> cut(const learn::recognition::Touch& touch);

  std::size_t taxels_;
  FrameResampler resampler_;
  learn::recognition::TouchFinder finder_;
  bool is_rested_ = false;  ///< There was a frame without a touch.
  std::vector<float> ring_;
  std::size_t frame_ = 0;      ///< How many came.
  std::size_t free_from_ = 0;  ///< First frame that belongs to no touch before.
};

}  // namespace dermis::out::serve
