// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>

#include "dermis/touch/frames/frames.hpp"

namespace dermis::live::sources {

/// How long after the frame of time `first` that of `time` is due, at `speed` times their pace. Whatever a file says,
/// at most 31 years.
[[nodiscard]] inline Nanos due_after(Nanos first, Nanos time, double speed = 1.0) {
  constexpr double kMost = 1e18;  // [ns]
  const double recorded_ns = static_cast<double>(time.count()) - static_cast<double>(first.count());
  return Nanos(std::llround(std::clamp(recorded_ns / speed, 0.0, kMost)));
}

/// Waits for moments since its making, by the steady clock, so that errors do not add up. Not thread-safe.
class Pacer {
 public:
  /// `stop` null: waits in any case.
  explicit Pacer(const std::atomic<bool>* stop) : stop_(stop) {}

  /// False where the stop flag was set meanwhile; it is looked at ten times a second.
  bool wait_until(Nanos since_begin) {
    const auto deadline = begin_ + since_begin;
    for (;;) {
      if (stop_ != nullptr && stop_->load()) return false;
      const auto now = std::chrono::steady_clock::now();
      if (now >= deadline) return true;
      std::this_thread::sleep_until(std::min(deadline, now + kTick));
    }
  }

  [[nodiscard]] Nanos elapsed() const { return std::chrono::steady_clock::now() - begin_; }

 private:
  static constexpr std::chrono::milliseconds kTick{100};
  const std::atomic<bool>* stop_;
  std::chrono::time_point<std::chrono::steady_clock, Nanos> begin_ = std::chrono::steady_clock::now();
};

}  // namespace dermis::live::sources
