// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <vector>

namespace dermis::fusion {

/// Where a strip (an array of one row or one column) is touched, learned from touches whose positions were known:
/// taxels that overlap, and those missing beyond the ends, pull the centre of mass of the signals
/// (ForceFrame::signal_to_noise) aside. Places are from the centre of the first taxel, along the strip.
struct StripTable {
  std::vector<double> centre_m;    ///< Centre of mass of the signals [m], rising; at least 2.
  std::vector<double> position_m;  ///< Position of a touch that has it [m], not falling.
  double sigma_m = 0.0;            ///< Standard deviation of a touch from the table, its noise left out [m], >= 0.

  struct Place {
    double position_m = 0.0;
    double slope = 0.0;  ///< d position / d centre, >= 0.
  };
  /// Straight between the knots, constant beyond the ends.
  [[nodiscard]] Place at(double centre_m) const noexcept;

  /// Both vectors have the same size and every number is in its range.
  [[nodiscard]] bool is_consistent() const noexcept;
};

}  // namespace dermis::fusion
