// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "live/threats/rate_window.hpp"

#include <chrono>
#include <cmath>

namespace dermis::live::threats {

std::optional<RateWindow::Rate> RateWindow::add(Nanos time, double value, double sigma) noexcept {
  if (count_ > 0 && time < sample(count_ - 1).time) forget();
  const Sample now{time, value, sigma * sigma};
  const Nanos start = time - window_;
  drop_before(start);
  std::optional<Rate> rate;
  if (count_ > 0 && sample(0).time <= start) {
    const Sample& before = sample(0);
    const Sample& after = count_ > 1 ? sample(1) : now;
    const double share =
        static_cast<double>((start - before.time).count()) / static_cast<double>((after.time - before.time).count());
    const double then = before.value + share * (after.value - before.value);
    const double then_variance = (1.0 - share) * (1.0 - share) * before.variance + share * share * after.variance;
    const double seconds = std::chrono::duration<double>(window_).count();
    rate = {(value - then) / seconds, std::sqrt(now.variance + then_variance) / seconds};
  }
  store(now);
  return rate;
}

/// Keeps the last of them, which has the value at `start`.
void RateWindow::drop_before(Nanos start) noexcept {
  while (count_ > 1 && sample(1).time <= start) {
    first_ = (first_ + 1) % kMostSamples;
    --count_;
  }
}

/// Stores some of frames that come too fast for the samples.
void RateWindow::store(const Sample& now) noexcept {
  const Nanos least = window_ / static_cast<Nanos::rep>(kMostSamples - 4);
  if (count_ > 0 && now.time - sample(count_ - 1).time < least) return;
  if (count_ == kMostSamples) return;
  sample(count_++) = now;
}

}  // namespace dermis::live::threats
