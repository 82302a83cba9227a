// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace dermis::simulation {

/// The divider whose idle rows are grounded and whose columns are all loaded, in SIMD lanes, for arrays of up to
/// kMostLines columns. The row lines are eliminated by hand, their block of the nodal equations being diagonal, which
/// also admits drivers of 0 ohm; a symmetric, diagonally dominant system for the columns is left,
///
///   C = diag(1/RL_j + sum_i G_ij) - sum_i (Rd_i / a_i) g_i g_i^T,   a_i = 1 + Rd_i sum_j G_ij,   g_i row i of G,
///
/// which Gauss and Jordan invert without pivoting; the readings are T = diag(1/a) G C^-1. Thread-safe.
template <typename Real>
class GroundedDividerForward {
 public:
  static constexpr std::size_t kMostLines = 64;

  GroundedDividerForward(const std::vector<double>& drive_ohm, const std::vector<double>& load_ohm);

  /// `siemens` and `ratio` are [rows, cols]; ratio is the reading over the supply.
  void ratios(std::span<const Real> siemens, std::span<Real> ratio) const noexcept;

 private:
  std::vector<Real> drive_ohm_;
  std::vector<Real> load_siemens_;
};

extern template class GroundedDividerForward<float>;
extern template class GroundedDividerForward<double>;

}  // namespace dermis::simulation
