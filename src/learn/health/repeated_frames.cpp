// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/health/repeated_frames.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace dermis::learn::health {
namespace {

constexpr std::size_t kFewestMeasured = 50;
constexpr std::size_t kLongRun = 100;
constexpr double kNoisyShare = 0.3;     // of readings that change in a frame that is measured
constexpr double kManyRepeated = 0.25;  // of the frames

/// A readout that cuts small readings off sends the same value of all taxels as long as nothing is pressed.
bool is_cut_off(std::span<const float> counts) {
  return std::all_of(counts.begin(), counts.end(), [&](float count) { return count == counts.front(); });
}

}  // namespace

void RepeatedFrames::add(std::span<const float> counts) {
  std::size_t changed = last_.empty() ? counts.size() : 0;
  for (std::size_t taxel = 0; taxel < last_.size(); ++taxel) changed += counts[taxel] != last_[taxel] ? 1 : 0;
  last_.assign(counts.begin(), counts.end());
  changed_readings_ += changed;
  const bool is_repeated = changed == 0 && !is_cut_off(counts);
  run_ = is_repeated ? run_ + 1 : 0;
  repeated_ += is_repeated ? 1 : 0;
  if (run_ > longest_) {
    longest_ = run_;
    longest_end_ = frames_;
  }
  ++frames_;
}

/// Without noise, an array at rest repeats itself as it should.
bool RepeatedFrames::has_noise() const noexcept {
  const std::size_t measured = frames_ - repeated_;
  return measured >= kFewestMeasured && static_cast<double>(changed_readings_) > kNoisyShare *
                                                                                     static_cast<double>(measured) *
                                                                                     static_cast<double>(last_.size());
}

std::optional<std::string> RepeatedFrames::finding() const {
  if (!has_noise() || longest_ < kLongRun) return std::nullopt;
  return fmt::format("frames {} to {} are all the same: the device, its wire or its reader hangs",
                     longest_end_ - longest_, longest_end_);
}

std::optional<std::string> RepeatedFrames::remark() const {
  const std::size_t stale = repeated_ - (longest_ < kLongRun ? 0 : longest_);
  const double share = static_cast<double>(stale) / static_cast<double>(frames_);
  if (!has_noise() || share < kManyRepeated) return std::nullopt;
  return fmt::format("{:.0f} % of the frames repeat the one before: they are sent more often than they are measured",
                     100.0 * share);
}

}  // namespace dermis::learn::health
