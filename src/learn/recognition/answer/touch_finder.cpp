// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/recognition/touch_finder.hpp"

#include <algorithm>
#include <cmath>

namespace dermis::learn::recognition {
namespace {

constexpr std::size_t kMostFrames = 1000;

}  // namespace

Status TouchLimits::validate() const {
  if (!(onset > 0.0) || !std::isfinite(onset)) return bad_input("onset: must be above 0");
  if (!(release_share >= 0.0 && release_share <= 1.0)) return bad_input("release_share: must be 0 to 1");
  if (gap_frames < 1 || gap_frames > kMostFrames) return bad_input("gap_frames: must be 1 to 1000");
  if (before_frames > kMostFrames || after_frames > kMostFrames)
    return bad_input("frames around a touch: at most 1000");
  return Done{};
}

TouchFinder::TouchFinder(const TouchLimits& limits)
    : limits_(limits), recent_(std::max(kIdleFrames, limits.gap_frames)) {}

void TouchFinder::idle(double force) {
  idle_count_ = std::min(idle_count_ + 1, kIdleFrames);
  level_ = idle_level();
  if (!(force - level_ > limits_.onset)) return;
  is_touched_ = true;
  onset_ = last_held_ = frame_;
  peak_ = force - level_;
}

double TouchFinder::idle_level() const {
  double least = recent_[frame_ % recent_.size()];
  for (std::size_t back = 1; back < idle_count_; ++back) {
    least = std::min(least, recent_[(frame_ - back) % recent_.size()]);
  }
  return least;
}

Touch TouchFinder::end_touch() {
  const std::size_t before = std::min(limits_.before_frames, onset_ - free_from_);
  const Touch touch{onset_ - before, std::min(last_held_ + limits_.after_frames, frame_)};
  free_from_ = touch.last + 1;
  is_touched_ = false;
  idle_count_ = std::min(frame_ - last_held_, kIdleFrames);
  return touch;
}

std::optional<Touch> TouchFinder::next(double force) {
  recent_[frame_ % recent_.size()] = force;
  std::optional<Touch> touch;
  if (!is_touched_) {
    idle(force);
  } else {
    const double above = force - level_;
    peak_ = std::max(peak_, above);
    if (above > std::max(limits_.onset, limits_.release_share * peak_)) last_held_ = frame_;
    if (frame_ - last_held_ >= limits_.gap_frames) touch = end_touch();
  }
  ++frame_;
  return touch;
}

std::optional<Touch> TouchFinder::finish() {
  if (!is_touched_) return std::nullopt;
  --frame_;  // the last one that there was
  const Touch touch = end_touch();
  ++frame_;
  return touch;
}

std::vector<Touch> find_touches(const TouchLimits& limits, std::span<const double> forces) {
  TouchFinder finder(limits);
  std::vector<Touch> touches;
  for (const double force : forces) {
    if (const std::optional<Touch> touch = finder.next(force)) touches.push_back(*touch);
  }
  if (const std::optional<Touch> touch = finder.finish()) touches.push_back(*touch);
  return touches;
}

}  // namespace dermis::learn::recognition
