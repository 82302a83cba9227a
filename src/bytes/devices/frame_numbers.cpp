// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/devices/frame_numbers.hpp"

namespace dermis::bytes::devices {
namespace {

constexpr std::uint32_t kMostLate = 63;
constexpr Nanos kLatestTime{std::int64_t{1} << 62};

}  // namespace

bool FrameNumbers::is_late(std::uint32_t sequence, std::optional<std::uint32_t> time) const noexcept {
  if (!datagrams_ || !sequence_) return false;
  const std::uint32_t back = (static_cast<std::uint32_t>(*sequence_) - sequence) & mask_;
  const std::uint32_t time_back = time && time_ ? static_cast<std::uint32_t>(*time_) - *time : 0;
  return back <= kMostLate && time_back <= INT32_MAX;
}

bool FrameNumbers::count(std::uint32_t sequence, std::optional<std::uint32_t> time, Acquisition& acquisition) noexcept {
  if (is_late(sequence, time)) return false;
  const std::uint32_t step = (sequence - static_cast<std::uint32_t>(sequence_.value_or(0))) & mask_;
  const std::uint32_t time_step = time && time_ ? *time - static_cast<std::uint32_t>(*time_) : 0;
  const bool is_time_possible = static_cast<std::int64_t>(time_.value_or(0) + time_step) <= kLatestTime / time_unit_;
  const bool goes_on = sequence_ && step <= max_lost_ + 1 && time_step <= INT32_MAX && is_time_possible;
  sequence_ = goes_on ? *sequence_ + step : sequence;
  acquisition.sequence = sequence_;
  acquisition.lost_before = goes_on && step > 1 ? step - 1 : 0;
  if (!time) return true;
  time_ = goes_on && time_ ? *time_ + time_step : *time;
  acquisition.device_time = time_unit_ * static_cast<std::int64_t>(*time_);
  return true;
}

}  // namespace dermis::bytes::devices
