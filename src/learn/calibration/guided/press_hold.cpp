// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/guided/press_hold.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace dermis::learn::calibration {
namespace {

constexpr double kSteadyShare = 0.05;  // of the excess; creep stays below
constexpr double kSteadySigmas = 4.0;

}  // namespace

void PressHold::clear() {
  *this = PressHold(part_length_ * kParts);
}

void PressHold::feed(const RawFrame& raw, std::span<const double> ratio, std::span<const Reading> pressed) {
  if (has_begun() && raw.time - current_.mean.begin() >= part_length_) close_part(pressed);
  current_.mean.add(raw, ratio);
  current_.excess.resize(pressed.size());
  for (std::size_t k = 0; k < pressed.size(); ++k) current_.excess[k] += pressed[k].excess;
}

void PressHold::close_part(std::span<const Reading> pressed) {
  Part part = std::exchange(current_, {});
  if (!is_settled_) {
    is_settled_ = true;
    return;
  }
  if (!parts_.empty()) {
    was_unsteady_ = has_moved(part, pressed);
    if (was_unsteady_) return parts_.clear();
  }
  parts_.push_back(std::move(part));
}

bool PressHold::has_moved(const Part& part, std::span<const Reading> pressed) const {
  for (std::size_t k = 0; k < pressed.size(); ++k) {
    const double scatter = kSteadySigmas * pressed[k].noise / std::sqrt(static_cast<double>(part.mean.count()));
    const double moved = std::abs(part.mean_excess(k) - mean_excess(k));
    if (moved > kSteadyShare * mean_excess(k) + scatter) return true;
  }
  return false;
}

double PressHold::share(Nanos now) const noexcept {
  if (!has_begun()) return 0.0;
  const double begun =
      std::chrono::duration<double>(now - current_.mean.begin()) / std::chrono::duration<double>(part_length_);
  const double done = static_cast<double>(parts_.size()) + (is_settled_ ? 1.0 : 0.0) + std::min(begun, 1.0);
  return std::min(1.0, done / static_cast<double>(kParts + 1));
}

double PressHold::mean_excess(std::size_t pressed) const noexcept {
  if (parts_.empty()) return has_begun() ? current_.mean_excess(pressed) : 0.0;
  double sum = 0.0;
  for (const Part& part : parts_) sum += part.mean_excess(pressed);
  return sum / static_cast<double>(parts_.size());
}

std::vector<RawFrame> PressHold::frames(std::size_t count) const {
  std::vector<RawFrame> frames;
  for (std::size_t k = 0; k < count; ++k) {
    FrameMean mean;
    for (std::size_t part = k * kParts / count; part < (k + 1) * kParts / count; ++part) mean.add(parts_[part].mean);
    frames.push_back(mean.frame());
  }
  return frames;
}

}  // namespace dermis::learn::calibration
