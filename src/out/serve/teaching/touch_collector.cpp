// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/teaching/touch_collector.hpp"

#include <algorithm>

namespace dermis::out::serve {
namespace {

constexpr std::size_t kRestFrames = 15;
// Contacts stand out of the noise, and are 0 N without one.
constexpr learn::recognition::TouchLimits kLimits{
    .onset = 0.05, .release_share = 0.05, .gap_frames = 12, .before_frames = 1, .after_frames = 1};
constexpr std::size_t kKept = TouchCollector::kMostFrames + 2 * kRestFrames;

}  // namespace

TouchCollector::TouchCollector(std::size_t taxels)
    : taxels_(taxels), resampler_(kRateHz, taxels), finder_(kLimits), ring_(kKept * taxels) {}

std::optional<CollectedTouch> TouchCollector::next(const ForceFrame& force, const ContactReport& report) {
  if (has(force.status, FrameStatus::rejected)) return std::nullopt;
  if (resampler_.leaps_to(force)) {
    static_cast<void>(finder_.finish());
    free_from_ = frame_;
    is_rested_ = false;
  }
  is_rested_ = is_rested_ || report.total_force_n == 0.0;
  std::optional<CollectedTouch> collected;
  resampler_.take(force, [&](std::span<const float> newtons) {
    if (!is_rested_) return;
    keep(newtons);
    const std::optional<learn::recognition::Touch> touch = finder_.next(report.total_force_n);
    if (touch) collected = cut(*touch);
  });
  return collected;
}

void TouchCollector::keep(std::span<const float> newtons) {
  std::copy(newtons.begin(), newtons.end(), ring_.begin() + static_cast<std::ptrdiff_t>(frame_ % kKept * taxels_));
  ++frame_;
}

std::optional<CollectedTouch> TouchCollector::cut(const learn::recognition::Touch& touch) {
  const std::size_t begin = std::max(free_from_, touch.first - std::min(touch.first, kRestFrames));
  free_from_ = frame_;
  if (touch.last - touch.first >= kMostFrames || frame_ - begin > kKept) return std::nullopt;
  CollectedTouch collected;
  collected.first = touch.first - begin;
  collected.last = touch.last - begin;
  for (std::size_t frame = begin; frame < frame_; ++frame) {
    const auto place = ring_.begin() + static_cast<std::ptrdiff_t>(frame % kKept * taxels_);
    collected.frames.insert(collected.frames.end(), place, place + static_cast<std::ptrdiff_t>(taxels_));
  }
  return collected;
}

}  // namespace dermis::out::serve
