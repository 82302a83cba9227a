// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <vector>

#include "dermis/compensation/crosstalk.hpp"

namespace dermis::compensation {

/// Divider columns, idle rows grounded through their drivers. The readings T (rows x cols, reading / supply) follow
/// formula (1) of research/literature.md A.2,
///
///   T = D S^-1 G B^-1,   A = diag(gd + G 1),  B = diag(gL + G^T 1),  S = A - G B^-1 G^T,  D = diag(gd)
///
/// and G is found by the inversion-free fixed point (4) of A.5, written with Rd = 1 / gd so that ideal drivers
/// (Rd = 0, where the first step is already exact) need no exception:
///
///   W = (1 + Rd . G 1) T - G B^-1 G^T (Rd T),   sigma_j = sum_i W_ij,   G_ij = gL_j W_ij / (1 - sigma_j)
///
/// started at the solution for ideal drivers. Steps are halved whenever they stop shrinking (A.5, alpha = 0.5), and the
/// iteration starts anew with smaller steps where it runs away: taxels down to about a quarter of drive_ohm are found.
class GroundedDivider final : public CrosstalkInversion {
 public:
  GroundedDivider(const ArrayDescription& array, double tolerance_ratio);
  [[nodiscard]] InversionResult invert(std::span<const double> ratio, std::span<double> siemens) noexcept override;
  void propagate_noise(double sigma_ratio, std::span<double> sigma_siemens) noexcept override;
  [[nodiscard]] double siemens_per_ratio() const noexcept override {
    return *std::max_element(load_siemens_.begin(), load_siemens_.end());
  }

 private:
  /// Every column voltage, all rows driven, is below the supply.
  [[nodiscard]] bool is_possible() const noexcept;
  void start(std::span<const double> ratio, std::span<double> siemens) noexcept;
  bool iterate(std::span<const double> ratio, std::span<double> siemens, double damping) noexcept;
  double step(std::span<const double> ratio, std::span<double> siemens, double damping) noexcept;
  void undo_drivers(std::span<const double> ratio, std::span<const double> siemens) noexcept;

  std::size_t rows_;
  std::size_t cols_;
  double tolerance_;
  std::vector<double> drive_ohm_;       // Rd [rows]
  std::vector<double> line_gain_;       // 1 + Rd . G 1 [rows]
  std::vector<double> load_siemens_;    // gL [cols]
  std::vector<double> column_siemens_;  // B [cols]
  std::vector<double> weighted_ratio_;  // Rd T [rows, cols]
  std::vector<double> coupling_;        // G^T (Rd T) [cols, cols]
  std::vector<double> undriven_;        // W [rows, cols]
  std::vector<double> column_share_;    // sigma [cols]
};

}  // namespace dermis::compensation
