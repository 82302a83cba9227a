// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "dermis/touch/frames/frames.hpp"

namespace dermis::live::threats {

/// How much a value has risen over a window of time, whatever the times of its samples: between two it is taken for
/// linear.
class RateWindow {
 public:
  explicit RateWindow(Nanos window) : window_(window) {}

  struct Rate {
    double per_second = 0.0;
    double sigma = 0.0;
  };

  /// The rate of the window that ends with this sample; empty where the samples do not reach back so far.
  std::optional<Rate> add(Nanos time, double value, double sigma) noexcept;

  void forget() noexcept { count_ = 0; }

 private:
  struct Sample {
    Nanos time{};
    double value = 0.0;
    double variance = 0.0;
  };

  static constexpr std::size_t kMostSamples = 64;

  [[nodiscard]] Sample& sample(std::size_t place) noexcept { return samples_[(first_ + place) % kMostSamples]; }
  void drop_before(Nanos start) noexcept;
  void store(const Sample& now) noexcept;

  Nanos window_;
  std::array<Sample, kMostSamples> samples_{};
  std::size_t first_ = 0;
  std::size_t count_ = 0;
};

}  // namespace dermis::live::threats
