// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <span>

#include "dermis/core/array_description.hpp"
#include "dermis/core/result.hpp"

namespace dermis::simulation {

/// From taxel conductances to readings, crosstalk included: for every driven row k the voltages u of the row lines and
/// v of the column lines follow from Kirchhoff's current law at every line,
///   [ A   -G ] [u]   [ gd .* s ]     A = diag(gd_i + sum_j G_ij), gd = 1/drive_ohm (0 for an idle floating row)
///   [-G^T  B ] [v] = [    0    ]     B = diag(1/load_ohm_j + sum_i G_ij), s = supply at row k, 0 V at idle rows
/// (nodal analysis; docs/simulation.md). What is read, over the supply:
///   divider:         v_j / supply
///   transimpedance:  the current into column j, which an ideal amplifier holds at 0 V, times load_ohm_j / supply;
///                    may exceed 1, the rails of the amplifier are those of the ADC
///   none:            conductance times kUnknownCircuitOhm, without crosstalk
/// and 1 minus this where pressure lowers the reading. Lines have no resistance of their own.
/// Thread-safe: ratios() only reads.
class ReadoutCircuit {
 public:
  static constexpr double kUnknownCircuitOhm = 100.0;  ///< Reading per conductance of `circuit = "none"` [ohm].

  [[nodiscard]] static Result<ReadoutCircuit> create(const ArrayDescription& array);

  /// `siemens` and `ratio` are [rows, cols]; conductances are finite and >= 0 [S]. ratio[k, j] is the reading of
  /// column j while row k is driven, over the supply.
  void ratios(std::span<const double> siemens, std::span<double> ratio) const;

 private:
  explicit ReadoutCircuit(const ArrayDescription& array)
      : readout_(array.readout), rows_(array.rows), cols_(array.cols) {}
  void divide(std::span<const double> siemens, std::span<double> ratio) const;
  void amplify(std::span<const double> siemens, std::span<double> ratio) const;

  Readout readout_;
  std::size_t rows_;
  std::size_t cols_;
};

}  // namespace dermis::simulation
