// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/guided/touch_sense.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace dermis::learn::calibration {
namespace {

constexpr double kLeastStepCounts = 3.0;  // between the means of two stretches that counts as a move
constexpr double kStepSigmas = 6.0;
constexpr double kLeastTouchCounts = 5.0;
constexpr double kTouchSigmas = 8.0;
constexpr double kLeastNoiseCounts = 1.0 / 3.0;  // rounding
constexpr double kFollowSeconds = 10.0;

/// Standard deviation of a reading from its steps from frame to frame, which drift does not enter.
double step_noise(const FrameMean& mean, std::size_t taxel) {
  if (mean.count() < 2) return 0.0;
  return std::sqrt(0.5 * mean.squared_steps(taxel) / static_cast<double>(mean.count() - 1));
}

}  // namespace

QuietWindow::QuietWindow(Nanos length, double ratio_per_count)
    : block_length_(length / kQuietBlocks), ratio_per_count_(ratio_per_count) {}

void QuietWindow::feed(const RawFrame& raw, std::span<const double> ratio) {
  if (current_.mean.count() > 0 && raw.time - current_.mean.begin() >= block_length_) {
    if (!quiet_.empty() && !agree(quiet_.back().mean, current_.mean)) {
      quiet_.clear();
      is_disturbed_ = true;
    }
    quiet_.push_back(std::exchange(current_, {}));
    if (quiet_.size() > 1) is_disturbed_ = false;
  }
  current_.mean.add(raw, ratio);
  keep(raw);
}

/// Half of the kept frames make room for as many again, so that those that are kept lie evenly.
void QuietWindow::keep(const RawFrame& raw) {
  if ((current_.mean.count() - 1) % current_.every != 0) return;
  std::vector<RawFrame>& frames = current_.frames;
  if (frames.size() == kMostFrames / kQuietBlocks) {
    std::size_t kept = 0;
    for (std::size_t k = 0; k < frames.size(); k += 2) std::swap(frames[kept++], frames[k]);
    frames.resize(kept);
    current_.every *= 2;
  }
  frames.push_back(raw);
}

bool QuietWindow::agree(const FrameMean& a, const FrameMean& b) const {
  const auto least = static_cast<double>(std::min(a.count(), b.count()));
  for (std::size_t taxel = 0; taxel < b.taxel_count(); ++taxel) {
    const double noise = std::max(step_noise(a, taxel), step_noise(b, taxel));
    const double most = std::max(kLeastStepCounts * ratio_per_count_, kStepSigmas * noise / std::sqrt(least));
    if (std::abs(a.mean_ratio(taxel) - b.mean_ratio(taxel)) > most) return false;
  }
  return true;
}

double QuietWindow::share(Nanos now) const noexcept {
  const double begun = current_.mean.count() == 0 ? 0.0
                                                  : std::chrono::duration<double>(now - current_.mean.begin()) /
                                                        std::chrono::duration<double>(block_length_);
  return std::min(1.0, (static_cast<double>(quiet_.size()) + begun) / static_cast<double>(kQuietBlocks));
}

std::vector<RawFrame> QuietWindow::frames() const {
  std::vector<RawFrame> frames;
  for (const Block& block : quiet_) frames.insert(frames.end(), block.frames.begin(), block.frames.end());
  return frames;
}

FrameMean QuietWindow::mean() const {
  FrameMean mean;
  for (const Block& block : quiet_) mean.add(block.mean);
  return mean;
}

TouchSense::TouchSense(const FrameMean& unloaded, double ratio_per_count)
    : ratio_per_count_(ratio_per_count), left_(unloaded.taxel_count()) {
  for (std::size_t taxel = 0; taxel < unloaded.taxel_count(); ++taxel) {
    level_.push_back(unloaded.mean_ratio(taxel));
    noise_.push_back(std::max(step_noise(unloaded, taxel), kLeastNoiseCounts * ratio_per_count));
  }
}

double TouchSense::threshold(std::size_t taxel) const noexcept {
  return std::max(kTouchSigmas * noise_[taxel], kLeastTouchCounts * ratio_per_count_);
}

double TouchSense::relative(std::span<const double> ratio, std::size_t taxel) const noexcept {
  return 1.0 + (ratio[taxel] - level_[taxel]) / std::max(level_[taxel], ratio_per_count_);
}

void TouchSense::follow(std::span<const double> ratio, double seconds) {
  const double share = -std::expm1(-seconds / kFollowSeconds);
  for (std::size_t taxel = 0; taxel < ratio.size(); ++taxel) level_[taxel] += share * excess(ratio, taxel);
}

void TouchSense::fade(std::span<const double> ratio) {
  for (std::size_t taxel = 0; taxel < ratio.size(); ++taxel) {
    left_[taxel] = std::clamp(ratio[taxel] - level_[taxel], 0.0, left_[taxel]);
  }
}

}  // namespace dermis::learn::calibration
