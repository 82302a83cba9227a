// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <chrono>
#include <cstddef>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::learn::calibration {

/// The presses that a person is asked for: every taxel with every weight, spread so that any beginning covers both.
struct CalibrationPlan {
  std::vector<std::size_t> taxels;                ///< Row-major, none twice.
  std::vector<double> weights_n;                  ///< 1 ... 16 weights of 0.01 ... 1000 N.
  Nanos unloaded_time = std::chrono::seconds(3);  ///< Quiet time at the beginning, 0.2 ... 60 s.
  Nanos hold_time = std::chrono::seconds(1);  ///< Time of every press, after a quarter of it to settle, 0.05 ... 30 s.

  [[nodiscard]] std::size_t press_count() const noexcept { return taxels.size() * weights_n.size(); }

  /// Number of pieces of a press's hold, 1, 2 or 4, whose means are kept. With it a taxel with at least three weights
  /// gets the samples that a network of its own needs.
  [[nodiscard]] std::size_t frames_per_press() const noexcept;

  /// Names the first field that is wrong, as "weights_n: ..."; at most kMostGuidedPresses presses.
  [[nodiscard]] Status validate(const ArrayDescription& array) const;
};

inline constexpr std::size_t kMostGuidedPresses = 8192;

/// Every `stride`-th row and column (>= 1), as far from the edges as possible, in reading order, without absent taxels.
[[nodiscard]] std::vector<std::size_t> taxels_with_stride(const ArrayDescription& array, std::size_t stride);

/// 1, 2, 5, 10 and 20 N on about 16 taxels all over the array.
[[nodiscard]] CalibrationPlan default_plan(const ArrayDescription& array);

}  // namespace dermis::learn::calibration
