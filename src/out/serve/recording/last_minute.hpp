// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory_resource>
#include <mutex>
#include <vector>

#include "dermis/touch/frames/frames.hpp"

namespace dermis::out::serve {

/// The frames of the last minute of each array, to be saved afterwards. All arrays together hold 16 MB at most: with
/// many or fast arrays there is less than a minute. Thread-safe.
class LastMinute {
 public:
  static constexpr Nanos kLongest = std::chrono::minutes(1);
  static constexpr std::size_t kMostBytes = 16U << 20U;

  explicit LastMinute(std::size_t arrays);

  /// On one thread for each array, which waits for a copy of a few frames at most. Time that goes back begins anew.
  void keep(std::size_t array, const RawFrame& frame);

  /// The frames from `first` to `last`, with the times in order; frames that are forgotten meanwhile are left out.
  [[nodiscard]] std::vector<RawFrame> frames(std::size_t array, Nanos first, Nanos last) const;

 private:
  struct Kept {
    RawFrame frame;                         ///< Without its counts;
    std::pmr::vector<std::uint16_t> whole;  ///< these have half the room
    std::pmr::vector<float> fractions;      ///< of these.
  };
  struct Track {
    mutable std::mutex mutex;
    std::pmr::unsynchronized_pool_resource room;  ///< Its own: else frames that come and go leave holes between others.
    std::pmr::deque<Kept> kept{&room};
  };

  [[nodiscard]] std::size_t most_frames(std::size_t taxels) const noexcept;
  [[nodiscard]] static bool copy_some(const Track& track, Nanos& first, Nanos last, std::vector<RawFrame>& frames);

  std::deque<Track> tracks_;
};

}  // namespace dermis::out::serve
