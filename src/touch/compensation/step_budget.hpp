// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace dermis::touch::compensation {

/// Work that one frame may take: much as long as frames are solved. After some unsolved ones in a row, a frame may take
/// a few times the work of the solved ones. Now and then one may take much again.
class StepBudget {
 public:
  /// `least`: of any frame, much is 8 times that; 0: nothing is ever bounded.
  explicit StepBudget(double least) : least_(least) {}

  /// `share` of the allowed work of a frame; below 1 it is another attempt at the same frame. Infinite: nothing is
  /// bounded, and this frame is no example.
  void start_frame(double share = 1.0) noexcept {
    const bool is_retry = share < 1.0;
    if (!is_retry) unsolved_ = is_solved_ ? 0 : unsolved_ + 1;
    is_solved_ = is_retry && is_solved_;
    used_ = 0.0;
    is_example_ = std::isfinite(share);
    const bool is_tried_again = unsolved_ % kTrial == 0 && !is_retry;
    const bool is_little = (is_retry || unsolved_ > kTrusted) && !is_tried_again;
    const double allowed = is_little ? share * (least_ + kTimes * typical_) : kMuch * least_;
    left_ = least_ > 0.0 && is_example_ ? allowed : std::numeric_limits<double>::infinity();
  }

  /// The frame is solved; its work is an example of what frames take.
  void learn() noexcept {
    is_solved_ = true;
    if (!is_example_) return;
    typical_ = typical_ == 0.0 ? used_ : typical_ + kShare * (std::min(used_, kMostRise * typical_) - typical_);
  }

  /// The next frame does not depend on those before.
  void forget() noexcept { *this = StepBudget(least_); }

  /// false: so much is not left.
  [[nodiscard]] bool take(double work) noexcept {
    used_ += work;
    left_ -= work;
    return left_ >= 0.0;
  }

  [[nodiscard]] bool is_used_up() const noexcept { return left_ <= 0.0; }

 private:
  static constexpr double kMuch = 8.0;
  static constexpr double kTimes = 2.5;
  static constexpr double kShare = 1.0 / 32.0;
  static constexpr double kMostRise = 2.0;
  static constexpr int kTrusted = 3;  // unsolved frames in a row
  static constexpr int kTrial = 64;   // of so many unsolved frames one may take much

  double least_;
  double typical_ = 0.0;
  double used_ = 0.0;
  double left_ = std::numeric_limits<double>::infinity();
  int unsolved_ = 0;
  bool is_solved_ = true;  // the last frame
  bool is_example_ = true;
};

}  // namespace dermis::touch::compensation
