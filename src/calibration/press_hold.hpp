// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "calibration/frame_mean.hpp"
#include "dermis/core/frames.hpp"

namespace dermis::calibration {

/// A press that is to be held: a quarter of its time to settle, then kParts quarters whose means agree. After a
/// quarter that does not agree it begins anew.
class PressHold {
 public:
  static constexpr std::size_t kParts = 4;

  explicit PressHold(Nanos length) : part_length_(length / kParts) {}

  void clear();
  /// `excess` of the pressed taxel over its unloaded reading, and the noise of it.
  void feed(const RawFrame& raw, std::span<const double> ratio, double excess, double noise);

  [[nodiscard]] bool has_begun() const noexcept { return current_.mean.count() > 0; }
  [[nodiscard]] bool is_done() const noexcept { return is_settled_ && parts_.size() == kParts; }
  [[nodiscard]] bool was_unsteady() const noexcept { return was_unsteady_; }
  [[nodiscard]] double share(Nanos now) const noexcept;
  /// Of the parts that are there, or of the present one.
  [[nodiscard]] double mean_excess() const noexcept;
  /// Means of the hold in `count` pieces of equal length; `count` divides kParts.
  [[nodiscard]] std::vector<RawFrame> frames(std::size_t count) const;

 private:
  struct Part {
    FrameMean mean;
    double excess = 0.0;  // sum
    [[nodiscard]] double mean_excess() const noexcept { return excess / static_cast<double>(mean.count()); }
  };
  void close_part(double noise);

  Nanos part_length_;
  Part current_;
  std::vector<Part> parts_;
  bool is_settled_ = false;
  bool was_unsteady_ = false;
};

}  // namespace dermis::calibration
