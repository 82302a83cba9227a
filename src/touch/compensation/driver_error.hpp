// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"

namespace dermis::touch::compensation {

/// The effect of drivers that are known only to a standard deviation, where idle rows are grounded through them. A
/// driver k that is wrong by s moves its row by s times its current, in all scans. With the symbols of GroundedRows,
/// the readings fixed (docs/reasons/derivations-circuits.md, "Wrong drivers"),
///
///   d G_ij / d s_k = L_ik p_kj + G_ij (Rd_i L_ik sum_m p_km + c_kj) - [i = k] G_ij^2
///   L = diag(G 1) - G diag(eta) G^T,   p_kj = y_kj / w_j
///   all loaded:  c_kj = RL_j p_kj sum_i L_ik
///   one loaded:  c_kj = G_kj y_kj / sum_i (1 + G_ij Rd_i) y_ij
///
/// of which the last term takes away what the taxel would have of it alone, which its calibration by presses has
/// learned with its law. The result is exact for ideal drivers and at virtual ground. Otherwise it lacks the term that
/// couples a taxel to those of other rows and columns at once, as in GroundedRows::propagate_noise. A share of the
/// errors' variance, drive_error_correlation, is common to all drivers.
///
/// Many members: the symbols of the formula, as add() may not allocate.
class DriverError {
 public:
  /// The circuit of GroundedRows, or that of VirtualGround with `column_ohm` 0. Rows are driven.
  DriverError(const ArrayDescription& array, std::vector<double> column_ohm);

  /// Adds it to the standard deviations of the taxels [rows, cols]. The conductances and y [S], `stride` apart from
  /// row to row. `between_rows`: of a film [rows - 1], or empty; its rows are in L, its columns nowhere. About 8 rows^2
  /// cols multiplications; rows cols with ideal columns. Allocates nothing.
  void add(const std::vector<double>& siemens, const std::vector<double>& current, std::size_t stride,
           std::span<const double> between_rows, std::span<double> sigma_siemens) noexcept;

 private:
  void find_columns(const double* siemens, const double* current, std::size_t stride) noexcept;
  void find_lifts(const double* siemens, std::size_t stride, std::span<const double> between_rows) noexcept;
  void add_driver(std::size_t row, std::size_t driver, const double* siemens) noexcept;

  std::size_t rows_;
  std::size_t cols_;
  bool one_loaded_;
  bool has_potential_;  // a column is not at 0 V, or a film joins the rows
  std::vector<double> drive_ohm_;
  std::vector<double> drive_error_ohm_;
  double correlation_;
  std::vector<double> column_ohm_;    // RL [cols]
  std::vector<double> shunt_;         // eta [cols]
  std::vector<double> shunted_;       // -diag(eta) G^T [cols, rows]
  std::vector<double> apparent_;      // p [rows, cols]
  std::vector<double> apparent_sum_;  // p 1 [rows]
  std::vector<double> column_share_;  // c over what follows [rows, cols]
  std::vector<double> column_gain_;   // all loaded: 1 L; one loaded: 1 [rows]
  std::vector<double> lift_;          // L [rows, rows]
  std::vector<double> common_;        // of one row's taxels: sum of errors [cols]
  std::vector<double> square_;        // of their squares
};

}  // namespace dermis::touch::compensation
