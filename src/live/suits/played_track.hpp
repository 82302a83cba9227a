// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>

#include "dermis/bytes/recordings/suit_recording.hpp"
#include "dermis/live/suits/playback.hpp"
#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/frames.hpp"

namespace dermis::live::suits {

/// Frames of an array that were read and wait for their moment.
struct PlayedTrack {
  using Clock = std::chrono::steady_clock;
  struct Waiting {
    Nanos time{};  ///< By which it is played.
    RawFrame frame;
  };

  bool is_used = false;  ///< Somebody takes the frames.
  std::deque<Waiting> waiting;
  bool is_shown_at_once = true;  ///< The next frame: after the beginning and after a seek.
  std::condition_variable changed;
  std::optional<RawFrame> shown;  ///< The last frame that was given.
  bool is_shown_again = false;    ///< It is to be given once more.

  std::map<Nanos, PlayedResults> results;  ///< By log time.
  bool has_results = false;

  SourceStatistics statistics;
  Clock::time_point rate_begin = Clock::now();
  std::uint64_t rate_frames = 0;

  void count(const RawFrame& frame);
  void keep(const bytes::recordings::RecordedResult& result);
  [[nodiscard]] PlayedResults results_of(Nanos time) const;
  /// Those of frames that were given long before `time`.
  void forget_results(Nanos time);
};

}  // namespace dermis::live::suits
