// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "dermis/bytes/recordings/suit_recording.hpp"
#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/playback.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::live::suits {

/// The results of a frame that a recording holds besides the readings, in CDR; empty where it holds none.
struct PlayedResults {
  std::vector<std::uint8_t> force;
  std::vector<std::uint8_t> contacts;
};

/// Plays the arrays of a recording on one clock, at the pace of their frame times. After a seek, each array gives its
/// first frame of that time or later at once, also while paused. Where a consumer is slower than the pace, the clock
/// waits for it: no frame is left out. Memory: the frames of a few tenths of a second. Thread-safe.
class Playback {
 public:
  /// `path`: "rec.mcap", or "rec.mcap#chest" for one array of it. Begins paused at the first frame.
  [[nodiscard]] static Result<std::unique_ptr<Playback>> open(const std::string& path);
  Playback(const Playback&) = delete;
  Playback& operator=(const Playback&) = delete;
  ~Playback();

  /// The arrays that are played.
  [[nodiscard]] const std::vector<bytes::recordings::RecordedArray>& arrays() const noexcept;
  [[nodiscard]] const std::string& path() const noexcept;  ///< The recording, without the name of an array.
  [[nodiscard]] Nanos start() const noexcept;              ///< Time of the first and of
  [[nodiscard]] Nanos end() const noexcept;                ///< the last frame.

  /// The frames of an array, for one thread; next() waits until a frame is due, and at the end for a seek; poll()
  /// never waits. They are as recorded, but for arrival_steady, which is now. Ask for it once for each array.
  [[nodiscard]] std::unique_ptr<FrameSource> source(std::size_t array);

  /// Those of a frame that source() gave within the last second of the recording, as it was live; empty where none is
  /// known.
  [[nodiscard]] PlayedResults results(std::size_t array, Nanos time) const;
  /// The recording holds forces of this array; known from the first of them on.
  [[nodiscard]] bool has_results(std::size_t array) const;

  PlaybackStatus control(const PlaybackCommand& command);
  [[nodiscard]] PlaybackStatus status() const;

  /// Every source gives its last frame once more, for somebody who has not seen it.
  void show_again();

  /// All sources end, now and for ever.
  void stop();

 private:
  class Implementation;
  class Source;
  explicit Playback(std::shared_ptr<Implementation> implementation);
  std::shared_ptr<Implementation> implementation_;
};

}  // namespace dermis::live::suits
