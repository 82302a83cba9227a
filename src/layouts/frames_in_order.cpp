// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "layouts/frames_in_order.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace dermis::layouts {
namespace {

constexpr Nanos kLatest = std::chrono::seconds(1);
constexpr std::size_t kMostWaitingReadings = std::size_t{1} << 24U;
constexpr std::uint64_t kMostLost = 1000;

}  // namespace

bool FramesInOrder::next(RawFrame& frame) {
  while (decoder_->next(frame)) {
    insert(frame);
    if (release(frame)) return true;
  }
  return release(frame);
}

void FramesInOrder::finish() {
  decoder_->finish();
  has_ended_ = true;
}

/// A frame that is more than a second back follows a restart of the device, and is no late one.
void FramesInOrder::insert(const RawFrame& frame) {
  auto place = waiting_.end();
  while (place != waiting_.begin() && std::prev(place)->acquisition.device_time > frame.acquisition.device_time &&
         *std::prev(place)->acquisition.device_time - *frame.acquisition.device_time <= kLatest) {
    --place;
  }
  waiting_.insert(place, frame);
}

bool FramesInOrder::release(RawFrame& frame) {
  if (waiting_.empty()) return false;
  const bool are_too_many = waiting_.size() * frame.counts.size() > kMostWaitingReadings;
  const Nanos waits = *waiting_.back().acquisition.device_time - *waiting_.front().acquisition.device_time;
  const bool is_due = has_ended_ || are_too_many || waits > kLatest || waits < -kLatest;
  if (!is_due) return false;
  frame = std::move(waiting_.front());
  waiting_.pop_front();
  const std::optional<std::uint64_t> number = frame.acquisition.sequence;
  const std::uint64_t step = number && last_number_ && *number > *last_number_ ? *number - *last_number_ : 1;
  frame.acquisition.lost_before = step <= kMostLost + 1 ? static_cast<std::uint32_t>(step - 1) : 0;
  last_number_ = number;
  const std::uint64_t lost = counts_.lost_frames + frame.acquisition.lost_before;
  const std::uint64_t frames = counts_.frames + 1;
  counts_ = decoder_->counts();
  counts_.frames = frames;
  counts_.lost_frames = lost;
  return true;
}

}  // namespace dermis::layouts
