// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <chrono>

namespace dermis::out::websocket {

/// Work that others may cause: some at once, and then so much a second. Not thread-safe.
class Budget {
 public:
  using Clock = std::chrono::steady_clock;

  Budget(double at_once, double a_second) : second_(1.0 / a_second), at_once_(duration(at_once)) {}

  /// May be more than is left; then free_at() is late.
  void spend(double amount, Clock::time_point now = Clock::now()) {
    whole_at_ = std::max(whole_at_, now) + duration(amount);
  }
  /// When there is some again.
  [[nodiscard]] Clock::time_point free_at() const noexcept { return whole_at_ - at_once_; }

 private:
  [[nodiscard]] Clock::duration duration(double amount) const {
    return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(amount * second_));
  }

  double second_;  ///< For one.
  Clock::duration at_once_;
  Clock::time_point whole_at_{};
};

}  // namespace dermis::out::websocket
