// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/websocket/taken_window.hpp"

#include <algorithm>

namespace dermis::out::websocket {
namespace {

constexpr double kFirstRate = 12.5e3;  // [bytes/s]
constexpr double kKept = 0.8;          // of the rate, while so little is sent that nothing is known of it
constexpr double kQueued = 0.15;       // [s]; longer times mean that messages wait for the line
constexpr std::chrono::milliseconds kLeastTime{150};

double seconds(TakenWindow::Clock::duration span) {
  return std::chrono::duration<double>(span).count();
}

}  // namespace

void TakenWindow::take(std::uint64_t bytes, std::uint64_t sent, Clock::time_point now) {
  taken_ = std::max(taken_, bytes);
  if (!has_report_) {
    has_report_ = true;
    rate_ = kFirstRate;
    mark_ = taken_;
    marked_ = now;
  }
  if (now - marked_ < kLeastTime) return;
  const double rate = static_cast<double>(taken_ - mark_) / seconds(now - marked_);
  const bool is_queued = static_cast<double>(sent) - static_cast<double>(taken_) > kQueued * rate;
  rate_ = is_queued ? rate : std::max(rate, kKept * rate_);
  mark_ = taken_;
  marked_ = now;
}

bool TakenWindow::is_open(std::uint64_t sent, std::uint64_t next) const noexcept {
  if (!has_report_ || sent < taken_ + kLeastBytes) return true;
  return static_cast<double>(sent - taken_ + next) < rate_ * seconds(kLongest);
}

}  // namespace dermis::out::websocket
