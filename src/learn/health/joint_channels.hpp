// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/frames.hpp"

namespace dermis::learn::health {

/// Channels of which none answers by itself: an input that floats behind a multiplexer. Their readings fall or rise one
/// after another in the order of the scan, or all together from frame to frame.
class JointChannels {
 public:
  explicit JointChannels(std::size_t taxels);

  /// The readings of a frame, all of them numbers.
  void add(std::span<const float> counts, const RawFrame& raw);

  [[nodiscard]] std::optional<std::string> finding() const;

  /// The readings that change most go on from frame to frame, and come and go, as those of touches do.
  [[nodiscard]] bool has_smooth_touches() const;

 private:
  /// Sums over the frames, of readings less the first.
  struct Channel {
    double first = 0.0;
    double last = 0.0;
    double sum = 0.0;
    double squares = 0.0;
    double with_all = 0.0;  ///< Products with the mean of all channels.
    double steps = 0.0;     ///< Squares of differences from frame to frame.
    double path = 0.0;      ///< Sum of the sizes of these differences,
    double longest = 0.0;   ///< and the largest.
    double least = 0.0;
    double most = 0.0;
  };

  void follow_all(double all, const RawFrame& raw);
  [[nodiscard]] double mean(const Channel& channel) const;
  [[nodiscard]] double variance(const Channel& channel) const;
  [[nodiscard]] bool has_slow_touches() const;
  [[nodiscard]] bool is_warmed() const;
  [[nodiscard]] double noise(const Channel& channel) const;
  [[nodiscard]] double gain(const Channel& channel) const;
  [[nodiscard]] double left(const Channel& channel) const;
  [[nodiscard]] bool answers_alone(const Channel& channel) const;
  [[nodiscard]] int direction(std::size_t from, std::size_t to) const;
  [[nodiscard]] bool is_ramp() const;
  [[nodiscard]] bool moves_together() const;

  std::vector<Channel> channels_;
  std::size_t frames_ = 0;
  double all_sum_ = 0.0;  // of the mean of all channels, less its first
  double all_squares_ = 0.0;
  double first_all_ = 0.0;
  double least_all_ = 0.0;
  double most_all_ = 0.0;
  double fastest_ = 0.0;  // change of it within a second or two
  double marked_all_ = 0.0;
  Nanos marked_{};
  std::optional<double> coldest_;
  std::optional<double> hottest_;
};

}  // namespace dermis::learn::health
