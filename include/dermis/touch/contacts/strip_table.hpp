// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <vector>

namespace dermis::touch::contacts {

/// The position of a touch on a strip (an array of one row or one column), learned from touches at known positions.
/// Overlapping taxels, and missing ones beyond the ends, shift the centre of mass of the signals
/// (ForceFrame::signal_to_noise). Positions are from the centre of the first taxel, along the strip.
struct StripTable {
  std::vector<double> centre_m;    ///< Centre of mass of the signals [m], rising; at least 2.
  std::vector<double> position_m;  ///< Position of a touch with that centre [m], not falling.
  double sigma_m = 0.0;  ///< Standard deviation of a touch's position from the table, without its noise [m], >= 0.

  struct Place {
    double position_m = 0.0;
    double slope = 0.0;  ///< d position / d centre, >= 0.
  };
  /// Straight between the knots, constant beyond the ends.
  [[nodiscard]] Place at(double centre_m) const noexcept;

  /// Both vectors have the same size and every number is in its range.
  [[nodiscard]] bool is_consistent() const noexcept;
};

}  // namespace dermis::touch::contacts
