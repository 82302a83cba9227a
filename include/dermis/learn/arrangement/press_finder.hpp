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

/// Finds presses in a stream. Its rest follows drift while nothing presses. A change of all
/// channels together is no press, and neither is one of a single frame. Not thread-safe.
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
  /// The last frames, for the median of three of each channel.
  struct Recent {
    std::vector<float> earlier;
    std::vector<float> last;
    std::vector<float> filtered;
  };
  /// A press that has not ended.
  struct Held {
    std::vector<double> sums;  ///< Of changes, by their weight.
    double weight = 0.0;
    double peak = 0.0;
    std::size_t frames = 0;
    std::size_t low_frames = 0;  ///< Since it seems to have ended.
    double low_seconds = 0.0;
    Nanos low_since{};
    Nanos begin{};
  };

  void filter(std::span<const float> counts);
  void find_changes();
  [[nodiscard]] std::size_t strongest() const;
  [[nodiscard]] double threshold(std::size_t channel) const;
  void follow(double seconds);
  void begin(double change);
  void gather(double change, double seconds);
  [[nodiscard]] Press answer() const;
  std::optional<Press> end();
  std::optional<Press> hold(std::size_t channel, double seconds);

  Rest rest_;
  Recent recent_;
  std::vector<float> change_;
  Held held_;
  std::vector<double> changes_;  // by the presses so far
  double typical_ = 0.0;         // their median
  double least_since_ = 0.0;     // the largest change at its smallest, after a press that the array remembers
  bool is_pressed_ = false;
  bool remembers_ = false;
  std::optional<Nanos> time_;  // of the last frame
};

/// The presses of a whole recording, at times since its first frame. It may begin and end with one.
[[nodiscard]] std::vector<Press> find_presses(std::span<const RawFrame> frames);

}  // namespace dermis::learn::arrangement
