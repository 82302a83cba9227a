// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "dermis/learn/calibration/evaluation.hpp"
#include "dermis/touch/frames/frames.hpp"

namespace dermis::learn::calibration {

/// The evidence of the known forces of a place on time, label by label.
class PlaceClock {
 public:
  /// Labels more than a second apart are not of one touch, and zero so long before a force is not its onset.
  void add(Nanos time, double newtons);

  /// Touch of the last label, where it is above zero.
  [[nodiscard]] TouchTime touch() const;

  /// Since the last force went, where the last label is zero and the force was seen going.
  [[nodiscard]] std::optional<double> seconds_since_release() const;

 private:
  std::optional<Nanos> last_;
  std::optional<Nanos> onset_;
  std::optional<Nanos> release_;
  double newtons_ = 0.0;  // from which it next changes
  std::optional<bool> is_unloading_;
};

}  // namespace dermis::learn::calibration
