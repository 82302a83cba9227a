// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "dermis/touch/frames/frames.hpp"

namespace dermis::bytes::files {

/// The times of a stream of frames, and what is wrong with them: a clock that restarts, another unit than seconds, a
/// rate that jumps. Memory does not grow with the frames. Not thread-safe.
class FrameTimes {
 public:
  /// The time of the next frame.
  void add(Nanos time);

  [[nodiscard]] std::size_t frames() const noexcept { return frames_; }

  /// From the first to the last frame [s]. A clock that restarts counts on, one step later.
  [[nodiscard]] double seconds() const;

  /// From a frame to the next [s], as most are; empty before there are enough.
  [[nodiscard]] std::optional<double> step_s() const;

  /// The steps of a device that nobody sets to whole half seconds: they scatter, or are of an odd length.
  [[nodiscard]] bool has_odd_steps() const;

  /// A sentence for each restart, few at most, and each jump of the rate, with the frame and its time.
  [[nodiscard]] std::vector<std::string> findings() const;

  /// A sentence for times that are milliseconds, or microseconds, rather than seconds. `is_smooth`: the readings go on
  /// from frame to frame as those of touches do, which makes slow frames unlikely.
  [[nodiscard]] std::optional<std::string> wrong_unit(bool is_smooth) const;

 private:
  struct Restart {
    std::size_t frame = 0;
    double before_s = 0.0;
    double after_s = 0.0;
  };
  /// Frames that follow each other.
  struct Block {
    std::size_t first_frame = 0;
    double begin_s = 0.0;  ///< Time of the first frame.
    double sum_s = 0.0;    ///< All steps but the longest two: those may be pauses.
    double longest_s = 0.0;
    double second_s = 0.0;
    double shortest_s = 0.0;
    std::size_t steps = 0;

    void add(double step_s);
    void append(const Block& next);
    [[nodiscard]] double mean_s() const;
  };

  void add_step(double step_s, double from_s);
  void halve();
  [[nodiscard]] std::vector<double> block_means() const;
  [[nodiscard]] std::optional<std::string> rate_jump() const;

  std::size_t frames_ = 0;
  std::optional<Nanos> last_;
  Nanos forward_{};  // sum of the steps that are no restarts
  std::size_t restarts_ = 0;
  std::vector<Restart> first_restarts_;
  std::vector<Block> blocks_;
  std::size_t block_steps_ = 32;
};

}  // namespace dermis::bytes::files
