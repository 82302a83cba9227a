// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/layouts/frames_in_order.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace dermis::bytes::layouts {
namespace {

constexpr Nanos kLatest = std::chrono::seconds(1);
constexpr std::size_t kMostWaitingReadings = std::size_t{1} << 24U;
constexpr std::uint64_t kMostLost = 1000;

/// A frame that is more than a second back follows a restart of the device, and is no late one.
bool comes_late(const std::optional<Nanos>& time, const std::optional<Nanos>& before) noexcept {
  return time && before && *before > *time && *before - *time <= kLatest;
}

}  // namespace

bool FramesInOrder::next(RawFrame& frame) {
  const bool is_found = find_next(frame);
  counts_.damaged_frames = decoder_->counts().damaged_frames;
  counts_.skipped_bytes = decoder_->counts().skipped_bytes;
  return is_found;
}

bool FramesInOrder::find_next(RawFrame& frame) {
  while (decoder_->next(frame)) {
    if (repeats(frame)) {
      ++counts_.repeated_frames;
    } else if (late_ == Late::wait_for) {
      insert(frame);
      if (release(frame, false)) return true;
    } else if (is_late(frame)) {
      ++counts_.late_frames;
    } else {
      deliver(frame, decoder_->frame_end());
      return true;
    }
  }
  return release(frame, has_ended_);
}

void FramesInOrder::finish() {
  decoder_->finish();
  has_ended_ = true;
}

bool FramesInOrder::repeats(const RawFrame& frame) {
  const Acquisition& now = frame.acquisition;
  if (!now.sequence) return false;
  const bool is_same = now.sequence == last_.sequence && now.device_time == last_.device_time;
  const bool is_repeated = is_same && !last_counts_.empty() && frame.counts == last_counts_;
  last_ = now;
  last_counts_.assign(frame.counts.begin(), frame.counts.end());
  return is_repeated;
}

bool FramesInOrder::is_late(const RawFrame& frame) const noexcept {
  return comes_late(frame.acquisition.device_time, delivered_time_);
}

void FramesInOrder::insert(const RawFrame& frame) {
  const std::optional<Nanos> time = frame.acquisition.device_time;
  const std::optional<Nanos> last =
      waiting_.empty() ? std::nullopt : waiting_.rbegin()->second.frame.acquisition.device_time;
  const bool is_late = comes_late(time, last);
  const bool goes_on = is_late || (time && last && *time >= *last);
  if (is_late) ++counts_.late_frames;
  if (!goes_on) ++run_;
  waiting_.insert({{run_, time.value_or(Nanos{})}, {frame, decoder_->frame_end()}});
}

bool FramesInOrder::release(RawFrame& frame, bool is_all_there) {
  if (waiting_.empty()) return false;
  const bool are_too_many = waiting_.size() * frame.counts.size() > kMostWaitingReadings;
  const std::optional<Nanos> first = waiting_.begin()->second.frame.acquisition.device_time;
  const std::optional<Nanos> last = waiting_.rbegin()->second.frame.acquisition.device_time;
  const bool waits = first && last && *last - *first <= kLatest && *first - *last <= kLatest;
  if (waits && !is_all_there && !are_too_many) return false;
  auto next = waiting_.extract(waiting_.begin());
  frame = std::move(next.mapped().frame);
  const std::uint64_t end = next.mapped().end;
  deliver(frame, end);
  return true;
}

/// Counts the frame, and those that are missing before it.
void FramesInOrder::deliver(RawFrame& frame, std::uint64_t end) {
  Acquisition& now = frame.acquisition;
  const bool goes_on = now.sequence && delivered_number_ && *now.sequence > *delivered_number_;
  const std::uint64_t step = goes_on ? *now.sequence - *delivered_number_ : 1;
  now.lost_before = step <= kMostLost + 1 ? static_cast<std::uint32_t>(step - 1) : 0;
  delivered_number_ = now.sequence;
  delivered_time_ = now.device_time;
  frame_end_ = end;
  ++counts_.frames;
  counts_.lost_frames += now.lost_before;
}

}  // namespace dermis::bytes::layouts
