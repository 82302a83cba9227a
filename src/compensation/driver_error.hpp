// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "dermis/core/array_description.hpp"

namespace dermis::compensation {

/// What drivers do that are known only to a standard deviation s [ohm]: a driven line is lower than it is taken to be
/// by its current, and an idle one that is grounded higher by what flows into it. Differentiating formula (1) of
/// docs/derivations.md for ideal drivers, with i a driven line, j a sensed one and r_ij its potential, what the error
/// of driver k does is
///
///   d G_ij / d s_k = G_ij [i = k] (S_k - G_ij) + Rl_j G_ij G_kj (S_k - T_k) - [i != k] G_kj L_ik
///   S_k = sum_m G_km (1 - r_km),   L_ik = sum_m G_km r_im,   T_k = sum of L_lk over l != k
///
/// of which the first term leaves out what the taxel would have of it alone, which its calibration by presses has
/// learned with its law. At virtual ground r and Rl are 0. Idle rows that float have no driver: i = k alone, without T.
/// Of the errors' variance a share, drive_error_correlation, is common to all drivers. Lines with resistance, and
/// sensed lines that float, are taken as if they were not.
class DriverError {
 public:
  explicit DriverError(const ArrayDescription& array);

  /// Adds it to the standard deviations of the taxels [rows, cols]; nothing where all drivers are exact. `ratio`: the
  /// readings over the supply.
  void add(std::span<const double> siemens, std::span<const double> ratio, std::span<double> sigma_siemens) noexcept;

 private:
  [[nodiscard]] std::size_t at(std::size_t driven, std::size_t sensed) const noexcept {
    return driven * driven_stride_ + sensed * sensed_stride_;
  }
  void find_currents(std::span<const double> siemens, std::span<const double> ratio) noexcept;
  void add_driver(std::size_t driven, std::size_t driver, std::span<const double> siemens) noexcept;

  std::vector<double> drive_error_ohm_;  // [driven lines]; empty: exact
  double correlation_;
  std::vector<double> load_ohm_;  // [sensed lines]; 0 at virtual ground
  bool has_potential_;            // sensed lines are not at virtual ground
  bool idle_lines_float_;
  std::size_t driven_stride_;  // from a taxel to the next driven line's
  std::size_t sensed_stride_;
  std::vector<double> current_;  // S_k - T_k [driven lines]
  std::vector<double> own_;      // S_k
  std::vector<double> lifted_;   // L_ik [driven lines, driven lines]
  std::vector<double> common_;   // of one driven line's taxels: sum of errors [sensed lines]
  std::vector<double> square_;   // of their squares
};

}  // namespace dermis::compensation
