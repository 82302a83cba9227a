// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "dermis/learn/calibration/recalibration.hpp"
#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/loads.hpp"

namespace dermis::learn::calibration {

/// How many taxels they press.
[[nodiscard]] std::size_t pressed_taxels(std::span<const KnownPress> presses);

/// Gathers the presses of a recording, frame by frame.
class KnownPresses {
 public:
  explicit KnownPresses(const ArrayDescription& array) : array_(array) {}

  /// The forces of the next frame, and its loads; none: it is not labelled.
  void add(const ForceFrame& force, std::span<const Load> loads);

  /// No more frames.
  void finish();

  [[nodiscard]] const std::vector<KnownPress>& presses() const { return presses_; }
  [[nodiscard]] std::size_t left_out() const { return left_out_; }

 private:
  /// A press that lasts.
  struct Touch {
    TaxelRegion where;
    std::vector<std::size_t> taxels;
    std::vector<double> share_sum;  // [taxels]
    double last_n = 0.0;            // read in the last labelled frame
    double log_sum = 0.0;
    double sigma_sum = 0.0;
    std::size_t frames = 0;  // labelled, with a force
  };

  void end_if_released(const ForceFrame& force, std::span<const Load> loads);
  Touch& touch_of(const Load& load);
  void end(const Touch& touch);

  const ArrayDescription& array_;
  std::vector<Touch> touches_;
  std::vector<KnownPress> presses_;
  std::size_t left_out_ = 0;
};

}  // namespace dermis::learn::calibration
