// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "live/suits/played_track.hpp"

namespace dermis::live::suits {
namespace {

constexpr Nanos kResultsKept = std::chrono::seconds(1);  // after their frame
constexpr Nanos kRatePeriod = std::chrono::seconds(1);

}  // namespace

void PlayedTrack::count(const RawFrame& frame) {
  ++statistics.frames;
  ++rate_frames;
  statistics.lost_frames += frame.acquisition.lost_before;
  const Clock::time_point now = Clock::now();
  if (now - rate_begin < kRatePeriod) return;
  statistics.rate_hz = static_cast<double>(rate_frames) / std::chrono::duration<double>(now - rate_begin).count();
  rate_frames = 0;
  rate_begin = now;
}

void PlayedTrack::keep(const bytes::recordings::RecordedResult& result) {
  PlayedResults& kept = results[result.time];
  const bool is_force = result.kind == bytes::recordings::RecordedResult::Kind::force;
  (is_force ? kept.force : kept.contacts).assign(result.message.begin(), result.message.end());
  has_results = has_results || is_force;
}

PlayedResults PlayedTrack::results_of(Nanos time) const {
  const auto found = results.find(time);
  return found == results.end() ? PlayedResults{} : found->second;
}

void PlayedTrack::forget_results(Nanos time) {
  results.erase(results.begin(), results.lower_bound(time - kResultsKept));
}

}  // namespace dermis::live::suits
