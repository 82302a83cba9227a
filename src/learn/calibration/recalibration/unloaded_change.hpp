// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>

#include "dermis/touch/pipeline/pipeline.hpp"

namespace dermis::learn::calibration {

/// How much more unloaded taxels conduct than when they were calibrated, from the frames in which nothing is touched.
class UnloadedChange {
 public:
  explicit UnloadedChange(const UnloadedLaw& calibrated) : calibrated_(calibrated) {}

  /// The frame that `pipeline` has processed last, which nothing presses.
  void add(touch::pipeline::Pipeline& pipeline);

  /// Relative. 0: within three standard deviations of it, less than 2 %, or more than a sheet drifts.
  [[nodiscard]] double change() const;

 private:
  const UnloadedLaw& calibrated_;
  std::size_t frames_ = 0;
  double sum_ = 0.0;  // of the changes in frames
  double squares_ = 0.0;
};

}  // namespace dermis::learn::calibration
