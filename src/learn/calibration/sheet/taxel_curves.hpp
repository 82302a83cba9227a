// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <vector>

#include "learn/calibration/sheet/single_presses.hpp"

namespace dermis::learn::calibration {

/// By how much each taxel conducts more under a load that stands on it. All taxels of a sheet share one curve, in
/// logarithms. A taxel deviates from it as its own presses show, and beyond them as the nearest of them.
class TaxelCurves {
 public:
  explicit TaxelCurves(const SinglePresses& single);

  /// Enough presses for a curve.
  [[nodiscard]] bool any() const noexcept { return sheet_.size() > 1; }
  /// Above the unloaded conductance, under `newtons` >= 0 [S].
  [[nodiscard]] double siemens(std::size_t taxel, double newtons) const;

 private:
  struct Point {
    double log_newtons = 0.0;
    double log_siemens = 0.0;  // of a taxel: above the sheet's
  };
  using Points = std::vector<Point>;

  void fit_sheet(const std::vector<Points>& measured);
  [[nodiscard]] double of_sheet(double log_newtons) const;
  [[nodiscard]] double slope_at(std::size_t point) const;
  [[nodiscard]] double end_slope(std::size_t end) const;

  Points sheet_;               // by force
  std::vector<Points> taxel_;  // [taxels], by force
};

}  // namespace dermis::learn::calibration
