// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "dermis/core/array_description.hpp"

namespace dermis::compensation {

/// What drivers do that are known only to a standard deviation s [ohm]: a driven line's voltage is wrong by its
/// current. Differentiating formula (1) of docs/derivations.md for ideal drivers, with i a driven and j a sensed line,
///
///   d ln G_ij = e_i + Rl_j sum_k G_kj e_k,   e_i = s_i sum_m G_im        (e_i alone at virtual ground)
///
/// less what the taxel would have of it alone, which its calibration by presses has learned with its law. Drivers are
/// taken to be wrong together and their parts not to cancel, which is the most they can do. Lines with resistance and
/// floating lines are taken as if they were ideal and grounded, which with `flexitac` is too much.
class DriverError {
 public:
  explicit DriverError(const ArrayDescription& array);

  /// Adds it to the standard deviations of the taxels [rows, cols]; nothing where all drivers are exact.
  void add(std::span<const double> siemens, std::span<double> sigma_siemens) noexcept;

 private:
  std::vector<double> drive_error_ohm_;  // [driven lines]; empty: exact
  std::vector<double> load_ohm_;         // [sensed lines]; 0 at virtual ground
  std::size_t driven_stride_;            // from a taxel to the next driven line's
  std::size_t sensed_stride_;
  std::vector<double> driven_;  // e_i
  std::vector<double> sensed_;  // Rl_j sum_k G_kj e_k
};

}  // namespace dermis::compensation
