// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/health/press_patterns.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "dermis/touch/frames/quantile.hpp"

namespace dermis::learn::health {
namespace {

constexpr std::size_t kFramesOfRest = 15;
constexpr float kStrong = 0.3F;  // of the largest change so far: a press

/// The scan may go along rows or columns, in either direction. None where a known trail is taken out of the readings.
std::vector<ScanTrail> all_trails(const ArrayDescription& array) {
  std::vector<ScanTrail> trails;
  if (array.readout.adc_errors.settling) return trails;
  for (const Axis axis : kAxes) {
    for (const bool backwards : {false, true}) trails.emplace_back(array, axis, backwards);
  }
  return trails;
}

}  // namespace

PressPatterns::PressPatterns(const ArrayDescription& array)
    : array_(&array),
      change_(array.taxel_count()),
      equal_{EqualLines(array, Axis::row), EqualLines(array, Axis::column)},
      trails_(all_trails(array)) {}

void PressPatterns::add(std::span<const float> counts) {
  if (!rest_.empty()) {
    judge(counts);
    return;
  }
  first_frames_.emplace_back(counts.begin(), counts.end());
  if (first_frames_.size() < kFramesOfRest) return;
  find_rest();
  for (const std::vector<float>& frame : std::exchange(first_frames_, {})) judge(frame);
}

/// A few of the frames may be pressed.
void PressPatterns::find_rest() {
  std::vector<float> readings(first_frames_.size());
  for (std::size_t taxel = 0; taxel < change_.size(); ++taxel) {
    for (std::size_t frame = 0; frame < readings.size(); ++frame) readings[frame] = first_frames_[frame][taxel];
    rest_.push_back(upper_median(readings));
  }
}

void PressPatterns::judge(std::span<const float> counts) {
  for (std::size_t taxel = 0; taxel < change_.size(); ++taxel) change_[taxel] = std::abs(counts[taxel] - rest_[taxel]);
  largest_change_ = std::max(largest_change_, *std::max_element(change_.begin(), change_.end()));
  if (largest_change_ == 0.0F) return;
  if (largest_change_ > 2.0F * largest_when_begun_) forget();
  const float strong = kStrong * largest_change_;
  const auto pressed = std::count_if(change_.begin(), change_.end(), [&](float change) { return change >= strong; });
  if (2 * static_cast<std::size_t>(pressed) > change_.size()) return;  // no press but a change of supply or temperature
  for (const Axis axis : kAxes) equal_[axis].add(counts, change_, strong);
  for (ScanTrail& trail : trails_) trail.add(change_, strong);
}

/// Beside a change so much larger, those before were no presses.
void PressPatterns::forget() {
  largest_when_begun_ = largest_change_;
  for (const Axis axis : kAxes) equal_[axis] = EqualLines(*array_, axis);
  trails_ = all_trails(*array_);
}

std::vector<std::string> PressPatterns::findings() const {
  std::vector<std::string> found;
  for (const Axis axis : kAxes) {
    for (std::string& finding : equal_[axis].findings(equal_[crossing(axis)])) found.push_back(std::move(finding));
  }
  for (const ScanTrail& trail : trails_) {
    if (auto finding = trail.finding()) found.push_back(*std::move(finding));
  }
  return found;
}

}  // namespace dermis::learn::health
