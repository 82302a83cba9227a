// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <span>
#include <string>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/axis.hpp"
#include "learn/health/equal_lines.hpp"
#include "learn/health/scan_trail.hpp"

namespace dermis::learn::health {

/// Faults that presses show in raw counts, whether they raise or lower them: equal lines and trails of the scan.
class PressPatterns {
 public:
  /// `array` must outlive it.
  explicit PressPatterns(const ArrayDescription& array);

  /// The readings of a frame, all of them numbers.
  void add(std::span<const float> counts);

  [[nodiscard]] std::vector<std::string> findings() const;

 private:
  void find_rest();
  void judge(std::span<const float> counts);
  void forget();

  const ArrayDescription* array_;
  std::vector<std::vector<float>> first_frames_;  // until the readings at rest are known
  std::vector<float> rest_;                       // medians of those [taxels]
  std::vector<float> change_;                     // of the last frame from them [taxels]
  float largest_change_ = 0.0F;
  float largest_when_begun_ = 0.0F;  // when the presses that count began
  PerAxis<EqualLines> equal_;
  std::vector<ScanTrail> trails_;
};

}  // namespace dermis::learn::health
