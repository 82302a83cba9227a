// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "dermis/touch/frames/frames.hpp"
#include "learn/calibration/guided/frame_mean.hpp"

namespace dermis::learn::calibration {

/// A press of one or more taxels that is to be held. A quarter of its time is for settling, then the means of kParts
/// quarters must agree on each of these taxels. After a quarter that does not agree it begins anew.
class PressHold {
 public:
  static constexpr std::size_t kParts = 4;

  explicit PressHold(Nanos length) : part_length_(length / kParts) {}

  void clear();
  /// A pressed taxel in one frame.
  struct Reading {
    double excess = 0.0;  ///< Over its unloaded reading.
    double noise = 0.0;   ///< Standard deviation of it.
  };
  /// `pressed`: the same taxels in every frame of a hold.
  void feed(const RawFrame& raw, std::span<const double> ratio, std::span<const Reading> pressed);

  [[nodiscard]] bool has_begun() const noexcept { return current_.mean.count() > 0; }
  [[nodiscard]] bool is_done() const noexcept { return is_settled_ && parts_.size() == kParts; }
  [[nodiscard]] bool was_unsteady() const noexcept { return was_unsteady_; }
  [[nodiscard]] double share(Nanos now) const noexcept;
  /// Mean excess of a pressed taxel in the finished parts, or in the present one.
  [[nodiscard]] double mean_excess(std::size_t pressed) const noexcept;
  /// Means of the hold in `count` pieces of equal length; `count` divides kParts.
  [[nodiscard]] std::vector<RawFrame> frames(std::size_t count) const;

 private:
  struct Part {
    FrameMean mean;
    std::vector<double> excess;  // sums
    [[nodiscard]] double mean_excess(std::size_t pressed) const noexcept {
      return excess[pressed] / static_cast<double>(mean.count());
    }
  };
  void close_part(std::span<const Reading> pressed);
  [[nodiscard]] bool has_moved(const Part& part, std::span<const Reading> pressed) const;

  Nanos part_length_;
  Part current_;
  std::vector<Part> parts_;
  bool is_settled_ = false;
  bool was_unsteady_ = false;
};

}  // namespace dermis::learn::calibration
