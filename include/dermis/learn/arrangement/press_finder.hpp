// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "dermis/touch/frames/frames.hpp"

/// Which channel of an unknown board is where.
namespace dermis::learn::arrangement {

/// The readings while nothing presses, in the unit of the readings, one value a channel.
struct Rest {
  std::vector<float> level;
  std::vector<float> noise;  ///< Standard deviation, > 0.
};

/// Median and median deviation of frames without a press; at least one frame, all of one size.
[[nodiscard]] Rest rest_of(std::span<const std::vector<float>> frames);

/// A press, from its onset to its release. Readings may rise or fall with it.
struct Press {
  std::size_t channel = 0;    ///< That changed most, beyond its noise.
  double change = 0.0;        ///< Of that channel, by its rest.
  std::size_t second = 0;     ///< The channel that changed most but for that one.
  double second_share = 0.0;  ///< Its change over that of `channel`, 0 to 1.
  Nanos begin{};              ///< Times of frames.
  Nanos end{};
};

/// Finds presses in a stream. Its rest follows drift while nothing presses. What all channels do together is no press,
/// and neither is what one frame alone shows. Not thread-safe.
class PressFinder {
 public:
  /// `typical`: the change by a press, where it is known; else the first presses tell it.
  explicit PressFinder(Rest rest, double typical = 0.0);

  /// The next frame, one reading a channel; what is not finite keeps its last reading. Returns a press that has ended.
  std::optional<Press> add(std::span<const float> counts, Nanos time);

  /// A press that has not ended when the frames do.
  std::optional<Press> finish();

  [[nodiscard]] bool is_pressed() const noexcept { return is_pressed_; }

 private:
  void filter(std::span<const float> counts);
  void find_changes();
  [[nodiscard]] std::size_t strongest() const;
  [[nodiscard]] double threshold(std::size_t channel) const;
  void follow(double seconds);
  void begin(double change);
  void gather(double change, double seconds);
  std::optional<Press> end();
  std::optional<Press> hold(std::size_t channel, double seconds);

  Rest rest_;
  std::vector<float> last_;      // the frame before this one,
  std::vector<float> earlier_;   // and the one before that
  std::vector<float> filtered_;  // median of three
  std::vector<float> change_;
  std::vector<float> scratch_;
  std::vector<double> sums_;   // of changes while pressed, by their weight
  std::vector<double> peaks_;  // of the presses so far
  double weight_ = 0.0;
  double peak_ = 0.0;
  double typical_ = 0.0;
  double least_since_ = 0.0;  // largest change at its smallest, after a press that the array still remembers
  double low_seconds_ = 0.0;
  std::size_t frames_ = 0;  // of the press
  std::size_t low_frames_ = 0;
  bool is_pressed_ = false;
  bool remembers_ = false;
  Nanos time_{};
  Nanos begin_{};
  Nanos low_since_{};
  bool has_time_ = false;
};

/// The presses of a whole recording, at times since its first frame. It may begin and end with one.
[[nodiscard]] std::vector<Press> find_presses(std::span<const RawFrame> frames);

}  // namespace dermis::learn::arrangement
