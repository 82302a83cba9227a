// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/recording/last_minute.hpp"

#include <algorithm>

#include "dermis/bytes/files/u16_counts.hpp"

namespace dermis::out::serve {
namespace {

constexpr std::size_t kFramesAtOnce = 64;  // are copied while the array waits

/// Whatever times a file has.
bool is_older(Nanos time, Nanos than, Nanos by) {
  return static_cast<double>(than.count()) - static_cast<double>(time.count()) > static_cast<double>(by.count());
}

RawFrame without_counts(const RawFrame& frame) {
  return {.time = frame.time,
          .temperature_celsius = frame.temperature_celsius,
          .supply_v = frame.supply_v,
          .counts = {},
          .acquisition = frame.acquisition,
          .sensor_celsius = frame.sensor_celsius};
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
  std::pmr::deque<Kept>& kept = track.kept;
  const bool is_whole = bytes::files::fit_u16(frame.counts);
  const std::lock_guard lock(track.mutex);
  if (!kept.empty() && frame.time == kept.back().frame.time) return;  // shown again
  if (!kept.empty() && frame.time < kept.back().frame.time) kept.clear();
  const std::size_t most = most_frames(is_whole ? frame.counts.size() : 2 * frame.counts.size());
  while (!kept.empty() && (kept.size() >= most || is_older(kept.front().frame.time, frame.time, kLongest))) {
    kept.pop_front();
  }
  Kept& next = kept.emplace_back(without_counts(frame), decltype(Kept::whole)(&track.room),
                                 decltype(Kept::fractions)(&track.room));
  if (!is_whole) {
    next.fractions.assign(frame.counts.begin(), frame.counts.end());
    return;
  }
  next.whole.resize(frame.counts.size());
  std::ranges::transform(frame.counts, next.whole.begin(),
                         [](float count) { return static_cast<std::uint16_t>(count); });
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
    frame.counts.assign(next->fractions.begin(), next->fractions.end());
    frame.counts.insert(frame.counts.end(), next->whole.begin(), next->whole.end());
    if (next->frame.time == last) return false;
    first = next->frame.time + Nanos(1);
  }
  return true;
}

}  // namespace dermis::out::serve
