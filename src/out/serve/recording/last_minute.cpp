// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/recording/last_minute.hpp"

#include <algorithm>
#include <utility>

#include "dermis/bytes/files/u16_counts.hpp"

namespace dermis::out::serve {
namespace {

constexpr std::size_t kFramesAtOnce = 64;  // are copied while the array waits

/// Whatever times a file has.
bool is_older(Nanos time, Nanos than, Nanos by) {
  return static_cast<double>(than.count()) - static_cast<double>(time.count()) > static_cast<double>(by.count());
}

void fill(RawFrame& frame, std::vector<std::uint16_t>& whole, const RawFrame& from, bool is_whole) {
  frame.time = from.time;
  frame.temperature_celsius = from.temperature_celsius;
  frame.sensor_celsius = from.sensor_celsius;
  frame.supply_v = from.supply_v;
  frame.acquisition = from.acquisition;
  frame.counts.clear();
  whole.clear();
  if (is_whole) {
    whole.resize(from.counts.size());
    std::ranges::transform(from.counts, whole.begin(), [](float count) { return static_cast<std::uint16_t>(count); });
  } else {
    frame.counts = from.counts;
  }
}

}  // namespace

LastMinute::LastMinute(std::size_t arrays) : tracks_(arrays) {}

/// Their size is that of whole counts; others have half as many.
std::size_t LastMinute::most_frames(std::size_t taxels) const noexcept {
  const std::size_t bytes = sizeof(Kept) + taxels * sizeof(std::uint16_t);
  return std::max<std::size_t>(1, kMostBytes / tracks_.size() / bytes);
}

void LastMinute::keep(std::size_t array, const RawFrame& frame) {
  Track& track = tracks_[array];
  std::deque<Kept>& kept = track.kept;
  const bool is_whole = bytes::files::fit_u16(frame.counts);
  const std::lock_guard lock(track.mutex);
  if (!kept.empty() && frame.time == kept.back().frame.time) return;  // shown again
  if (!kept.empty() && frame.time < kept.back().frame.time) kept.clear();
  const std::size_t most = most_frames(is_whole ? frame.counts.size() : 2 * frame.counts.size());
  const auto is_too_old = [&] { return !kept.empty() && is_older(kept.front().frame.time, frame.time, kLongest); };
  Kept next;
  while (is_too_old() || kept.size() >= most) {
    next = std::move(kept.front());  // its room is used again
    kept.pop_front();
  }
  fill(next.frame, next.whole, frame, is_whole);
  kept.push_back(std::move(next));
}

std::vector<RawFrame> LastMinute::frames(std::size_t array, Nanos first, Nanos last) const {
  std::vector<RawFrame> frames;
  while (copy_some(tracks_[array], first, last, frames)) {
  }
  return frames;
}

/// True where there may be more; `first` is then the time from which they come.
bool LastMinute::copy_some(const Track& track, Nanos& first, Nanos last, std::vector<RawFrame>& frames) {
  const std::lock_guard lock(track.mutex);
  auto next = std::ranges::lower_bound(track.kept, first, {}, [](const Kept& kept) { return kept.frame.time; });
  for (std::size_t copied = 0; copied < kFramesAtOnce; ++copied, ++next) {
    if (next == track.kept.end() || next->frame.time > last) return false;
    RawFrame& frame = frames.emplace_back(next->frame);
    if (!next->whole.empty()) frame.counts.assign(next->whole.begin(), next->whole.end());
    if (next->frame.time == last) return false;
    first = next->frame.time + Nanos(1);
  }
  return true;
}

}  // namespace dermis::out::serve
