// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/frames.hpp"

namespace dermis::touch::preprocessing {

/// Counts in how many frames taxels of the sheet have no reading. Not thread-safe.
class MissingReadings {
 public:
  explicit MissingReadings(ArrayDescription array) : array_(std::move(array)), missing_(array_.taxel_count()) {}

  /// Adds a frame of the array and its conditioned form; rejected frames are not counted. Returns whether some of its
  /// readings are outside of the range of the ADC. Allocates nothing.
  bool add(const RawFrame& raw, const ConditionedFrame& conditioned) noexcept;

  [[nodiscard]] bool any() const noexcept;

  /// Frames of which some readings are outside of the range of the ADC, rejected ones included.
  [[nodiscard]] std::size_t frames_outside() const noexcept { return frames_outside_; }

  /// "no reading (not a number, or outside the ADC) of r2c3 in 192, r0c1 in 3 of 192 frames": the worst taxels.
  [[nodiscard]] std::string describe() const;

  /// "readings of 3 to 409500, but the ADC gives 0 to 4095 (adc_bits = 12)"; empty where all were of the ADC's range.
  [[nodiscard]] std::optional<std::string> describe_range() const;

 private:
  bool add_range(const RawFrame& raw) noexcept;

  ArrayDescription array_;
  std::size_t frames_ = 0;
  std::size_t frames_outside_ = 0;
  float least_counts_ = std::numeric_limits<float>::infinity();
  float most_counts_ = -std::numeric_limits<float>::infinity();
  std::vector<std::size_t> missing_;  // frames [taxels]
};

}  // namespace dermis::touch::preprocessing
