// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace dermis::compensation {

/// Work that one frame may take: some times what the solved frames before took, so that the worst is not much slower
/// than the others. There is no bound until one is solved, or until the first frames are over.
class StepBudget {
 public:
  /// `least`: of any frame; 0: nothing is bounded.
  explicit StepBudget(double least) : least_(least) {}

  /// `share`: of what a frame may take; infinite: nothing is bounded, and this frame is no example.
  void start_frame(double share = 1.0) noexcept {
    used_ = 0.0;
    is_example_ = std::isfinite(share);
    left_ = std::numeric_limits<double>::infinity();
    if (least_ == 0.0 || !is_example_) return;
    const bool is_known = typical_ > 0.0 || frames_ == kFirstFrames;
    frames_ += is_known ? 0 : 1;
    if (is_known) left_ = share * (least_ + kTimes * typical_);
  }

  /// The work of this frame is an example of what frames take.
  void learn() noexcept {
    if (!is_example_) return;
    typical_ = typical_ == 0.0 ? used_ : typical_ + kShare * (std::min(used_, kMostRise * typical_) - typical_);
  }

  /// false: so much is not left.
  [[nodiscard]] bool take(double work) noexcept {
    used_ += work;
    left_ -= work;
    return left_ >= 0.0;
  }

  [[nodiscard]] bool is_used_up() const noexcept { return left_ <= 0.0; }

 private:
  static constexpr double kTimes = 2.5;
  static constexpr double kShare = 1.0 / 32.0;
  static constexpr double kMostRise = 2.0;
  static constexpr int kFirstFrames = 8;

  double least_;
  double typical_ = 0.0;
  double used_ = 0.0;
  bool is_example_ = true;
  double left_ = std::numeric_limits<double>::infinity();
  int frames_ = 0;
};

}  // namespace dermis::compensation
