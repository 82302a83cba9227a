// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <vector>

namespace dermis::paper {

/// MATLAB's Peaks, eq. (1) of the paper: the function on which it shows what a BP network can approximate.
[[nodiscard]] double peaks(double x, double y) noexcept;

/// The paper's training data: x and y in -3, -2.9, ..., 3.
struct PeaksSamples {
  static constexpr std::size_t kSide = 61;
  static constexpr std::size_t kCount = kSide * kSide;  ///< 3721

  std::vector<double> inputs;   ///< [kCount, 2]: x, y; x changes fastest.
  std::vector<double> targets;  ///< [kCount]
};
[[nodiscard]] PeaksSamples peaks_samples();

}  // namespace dermis::paper
