// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "live/buses/followed_sender.hpp"

#include <chrono>

namespace dermis::live::buses {
namespace {

using namespace std::chrono_literals;  // NOLINT(google-build-using-namespace): the literals only

constexpr Nanos kLeftAfter = 1s;
constexpr Nanos kLeap = 10s;                    // more than messages are late
constexpr Nanos kEnd = 24h * (365 * 130 + 32);  // the end of 2099, in nanoseconds far from the largest

}  // namespace

std::string_view FollowedSender::objection(const dds::Sample::Writer& writer, Nanos time, Nanos arrival) {
  if (last_ && arrival - last_->arrival >= kLeftAfter) last_.reset();
  if (last_ && writer != last_->writer) {
    return "frames of another sender are left out until the first has sent nothing for 1 s";
  }
  if (!is_possible(time, arrival)) return "frames whose time goes back or leaps ahead are left out";
  last_ = {writer, time, arrival};
  return {};
}

bool FollowedSender::is_possible(Nanos time, Nanos arrival) const noexcept {
  if (time < Nanos{} || time >= kEnd) return false;
  return !last_ || (time >= last_->time && time - last_->time <= arrival - last_->arrival + kLeap);
}

}  // namespace dermis::live::buses
