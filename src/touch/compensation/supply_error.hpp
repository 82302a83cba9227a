// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <span>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"

namespace dermis::touch::compensation {

/// The effect of a wrong supply: all readings of a frame are wrong by one factor, 1 + d. Differentiating formula (1) of
/// docs/reasons/derivations-circuits.md, for ideal drivers exactly and for others nearly,
///
///   d ln G_ij = (1 + Rd_i sum_k G_ik) (1 + Rl_j sum_k G_kj) d        (without the second factor at virtual ground)
///
/// so that a more loaded line counts more. Lines with resistance and floating lines are taken as if they were ideal and
/// grounded. Then it is 0.6 to 1.6 times the true change, for drivers up to 50 ohm and a quarter of the taxels at
/// 200 to 2000 ohm.
class SupplyError {
 public:
  explicit SupplyError(const ArrayDescription& array);

  /// Adds it to the standard deviations of the taxels [rows, cols]; all zero where the ADC's reference is the supply.
  /// `doubt`: relative error of the frame's supply beside its noise, 0 or more.
  void add(std::span<const double> siemens, double doubt, std::span<double> sigma_siemens) noexcept;

 private:
  std::size_t cols_;
  double supply_noise_;
  std::vector<double> row_ohm_;      // between a row and its voltage source or ground [rows]
  std::vector<double> column_ohm_;   // the same [cols]
  std::vector<double> row_gain_;     // [rows]
  std::vector<double> column_gain_;  // [cols]
};

}  // namespace dermis::touch::compensation
