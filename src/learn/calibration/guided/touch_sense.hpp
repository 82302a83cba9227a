// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "dermis/touch/frames/frames.hpp"
#include "learn/calibration/guided/frame_mean.hpp"

namespace dermis::learn::calibration {

/// The unloaded array, found in frames that show nothing but noise: kQuietBlocks stretches of time in a row whose means
/// agree on every taxel. Whatever moves begins it anew.
class QuietWindow {
 public:
  /// `ratio_per_count`: what one count of the ADC is as a ratio.
  QuietWindow(Nanos length, double ratio_per_count);

  void feed(const RawFrame& raw, std::span<const double> ratio);

  [[nodiscard]] bool is_done() const noexcept { return quiet_.size() >= kQuietBlocks; }
  [[nodiscard]] bool is_disturbed() const noexcept { return is_disturbed_; }
  [[nodiscard]] double share(Nanos now) const noexcept;
  /// Some of the single frames of the window, evenly, in order.
  [[nodiscard]] std::vector<RawFrame> frames() const;
  /// All of it.
  [[nodiscard]] FrameMean mean() const;

 private:
  static constexpr std::size_t kQuietBlocks = 4;
  static constexpr std::size_t kMostFrames = 128;

  struct Block {
    FrameMean mean;
    std::vector<RawFrame> frames;
    std::size_t every = 1;  // frame is kept
  };
  void keep(const RawFrame& raw);
  [[nodiscard]] bool agree(const FrameMean& a, const FrameMean& b) const;

  Nanos block_length_;
  double ratio_per_count_;
  Block current_;
  std::vector<Block> quiet_;
  bool is_disturbed_ = false;
};

/// Compares readings with those of the unloaded array. Idle readings are followed slowly, so drift of the array over an
/// hour does not count as a touch. Nor does the material's memory of a press.
class TouchSense {
 public:
  TouchSense(const FrameMean& unloaded, double ratio_per_count);

  /// The taxel that rises most of those that `counts` is true for, if one of them stands out of the noise.
  template <typename Counts>
  [[nodiscard]] std::optional<std::size_t> strongest(std::span<const double> ratio, const Counts& counts) const {
    std::optional<std::size_t> strongest;
    for (std::size_t taxel = 0; taxel < ratio.size(); ++taxel) {
      const double least = strongest ? std::max(excess(ratio, *strongest), threshold(taxel)) : threshold(taxel);
      if (excess(ratio, taxel) > least && counts(taxel)) strongest = taxel;
    }
    return strongest;
  }
  /// Takes the readings of an array that nothing touches, `seconds` after the last one.
  void follow(std::span<const double> ratio, double seconds);
  /// A weight is taken off the taxel: what it still reads is memory of the material, from now on.
  void leave(std::span<const double> ratio, std::size_t taxel) {
    left_[taxel] = std::max(0.0, ratio[taxel] - level_[taxel]);
  }
  /// Memory that has faded does not come back. For every frame.
  void fade(std::span<const double> ratio);

  /// Over the unloaded reading and over what the material remembers.
  [[nodiscard]] double excess(std::span<const double> ratio, std::size_t taxel) const noexcept {
    return ratio[taxel] - level_[taxel] - left_[taxel];
  }
  [[nodiscard]] double noise(std::size_t taxel) const noexcept { return noise_[taxel]; }
  /// Excess that stands out of the noise.
  [[nodiscard]] double threshold(std::size_t taxel) const noexcept;
  /// Reading over that of the unloaded taxel.
  [[nodiscard]] double relative(std::span<const double> ratio, std::size_t taxel) const noexcept;

 private:
  double ratio_per_count_;
  std::vector<double> level_;
  std::vector<double> left_;  // by presses, in the material
  std::vector<double> noise_;
};

}  // namespace dermis::learn::calibration
