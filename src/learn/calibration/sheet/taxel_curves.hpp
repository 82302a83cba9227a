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
  /// Only the curve of the sheet is that of `single`: the taxels deviate from it as in `known`.
  TaxelCurves(const SinglePresses& single, const TaxelCurves& known);

  /// Presses tell at least straight lines.
  [[nodiscard]] bool any() const noexcept { return !sheet_.empty(); }
  /// All presses are about as heavy: the curves are straight lines from nothing.
  [[nodiscard]] bool are_straight() const noexcept { return sheet_.size() == 1; }
  /// Above the unloaded conductance, under `newtons` >= 0 at the middle of the temperatures [S].
  [[nodiscard]] double siemens(std::size_t taxel, double newtons) const;
  /// A rise at this temperature as it would be at the middle of all [S].
  [[nodiscard]] double at_middle(double siemens, double temperature) const;

 private:
  struct Point {
    double log_newtons = 0.0;
    double log_siemens = 0.0;  // of a taxel: above the sheet's
    double temperature = 0.0;
    std::size_t taxel = 0;
  };
  using Points = std::vector<Point>;

  [[nodiscard]] static Points points(const SinglePresses& single);
  void fit_sheet(const Points& measured, const std::vector<double>& level);
  void fit_temperature(const Points& measured, const std::vector<double>& level);
  void fit_levels(const Points& measured, std::vector<double>& level) const;
  [[nodiscard]] double own_at(std::size_t taxel, double log_newtons) const;
  [[nodiscard]] double above_sheet(const Point& point) const;
  [[nodiscard]] double temperature_factor(double t) const;
  [[nodiscard]] double of_sheet(double log_newtons) const;
  [[nodiscard]] double slope_at(std::size_t point) const;
  [[nodiscard]] double end_slope(std::size_t end) const;

  Points sheet_;                  // by force
  double per_temperature_ = 0.0;  // of the logarithm of a rise
  double per_square_ = 0.0;
  std::vector<Points> taxel_;  // [taxels], by force
};

}  // namespace dermis::learn::calibration
