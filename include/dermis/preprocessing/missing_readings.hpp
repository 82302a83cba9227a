// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "dermis/core/array_description.hpp"
#include "dermis/core/frames.hpp"

namespace dermis::preprocessing {

/// Counts in how many frames taxels of the sheet have no reading. Not thread-safe.
class MissingReadings {
 public:
  explicit MissingReadings(ArrayDescription array) : array_(std::move(array)), missing_(array_.taxel_count()) {}

  /// Adds a frame of the array; rejected frames are not counted. Allocates nothing.
  void add(const ConditionedFrame& conditioned) noexcept;

  [[nodiscard]] bool any() const noexcept;

  /// "no reading (not a number, or outside the ADC) of r2c3 in 192, r0c1 in 3 of 192 frames": the worst taxels.
  [[nodiscard]] std::string describe() const;

 private:
  ArrayDescription array_;
  std::size_t frames_ = 0;
  std::vector<std::size_t> missing_;  // frames [taxels]
};

}  // namespace dermis::preprocessing
