// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <limits>

#include "dermis/touch/frames/frames.hpp"

namespace dermis::touch::compensation {

/// Residual of a frame that is cut short and has forces, as a ratio, from which the next one may go on.
inline constexpr double kMostLeft = 0.05;

/// Work that one frame may take, in any unit. Frames save what they do not take. So a hard frame after easy ones may
/// take much, and hard frames in a row together little more than good ones.
class StepBudget {
 public:
  /// `most`: of one frame; 0: nothing is ever bounded. So many hard `frames` may follow each other. On average a frame
  /// may take `each`, and twice what good ones take. Frames that come less often than at 1 kHz may take more.
  StepBudget(double most, double each, double frames = 1.0)
      : most_(most), each_(each), most_saved_(frames * most), saved_(most_saved_) {}

  void start_frame(Nanos time) noexcept {
    // Times of files can be any: their difference may not be a whole number of 64 bits.
    const double periods = 1e-6 * (static_cast<double>(time.count()) - static_cast<double>(last_time_.count()));
    last_time_ = time;
    const double gain = std::clamp(periods, 1.0, kMostPeriods) * each_ + kTimes * typical_;
    saved_ = std::min(most_saved_, std::max(saved_, -kMostOwed * each_) + gain);
    used_ = 0.0;
    start_attempt(1.0);
  }

  /// Another attempt at the frame, or the first of several: it may take this share of what is left.
  void start_attempt(double share) noexcept {
    left_ = most_ > 0.0 ? share * std::min(saved_, most_) : std::numeric_limits<double>::infinity();
  }

  /// The frame is a good one, and solved; its work is an example of what frames take.
  void learn() noexcept {
    typical_ = typical_ == 0.0 ? used_ : typical_ + kShare * (std::min(used_, kMostRise * typical_) - typical_);
  }

  /// The next frame does not depend on those before.
  void forget() noexcept {
    saved_ = most_saved_;
    typical_ = 0.0;
  }

  /// false: so much is not left, and the attempt is over.
  [[nodiscard]] bool take(double work) noexcept {
    if (work > left_) {
      left_ = 0.0;
      return false;
    }
    spend(work);
    left_ -= work;
    return true;
  }

  /// In any case, even where it is not left.
  void spend(double work) noexcept {
    used_ += work;
    saved_ -= work;
  }

  [[nodiscard]] bool is_used_up() const noexcept { return left_ <= 0.0; }

  /// Frames before have taken most of what was saved.
  [[nodiscard]] bool is_scarce() const noexcept { return saved_ < kScarce * most_; }

 private:
  static constexpr double kTimes = 2.0;
  static constexpr double kMostOwed = 2.0;
  static constexpr double kMostPeriods = 8.0;
  static constexpr double kShare = 1.0 / 256.0;
  static constexpr double kMostRise = 2.0;
  static constexpr double kScarce = 0.25;

  double most_;
  double each_;
  double most_saved_;
  double saved_;
  Nanos last_time_{};
  double typical_ = 0.0;
  double used_ = 0.0;
  double left_ = std::numeric_limits<double>::infinity();
};

}  // namespace dermis::touch::compensation
