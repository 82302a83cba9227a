// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::learn::simulation {

/// Computes readings from taxel conductances, crosstalk included, for every circuit of core/array_description.hpp. For
/// each driven line, Kirchhoff's current law at every line gives the voltages of all lines (nodal analysis,
/// docs/reasons/simulation.md). The reading, over the supply, is
///   divider, flexitac: the voltage of the sensed line across its load_ohm
///   transimpedance:    r = (I load_ohm - o) / (1 + 1/amplifier_gain), with I the current into the amplifier over the
///                      supply and o its offset over the nominal supply_v: minus the amplifier's output. Its input is
///                      at (o gain + I load_ohm)/(1 + gain). r may exceed 1 or be below 0: the rails are those of
///                      the ADC
///   none:              conductance times kUnknownCircuitOhm, without crosstalk
/// and 1 minus this where pressure lowers the reading. supply_ohm lowers the source of the driven line by the current
/// of that line. A line with a segment resistance has its driver, load or amplifier at the taxel of row or column 0.
/// Right to about 1e-12 of each reading. Thread-safe: ratios() only reads.
class ReadoutCircuit {
 public:
  static constexpr double kUnknownCircuitOhm = 100.0;  ///< Reading per conductance of `circuit = "none"` [ohm].

  [[nodiscard]] static Result<ReadoutCircuit> create(const ArrayDescription& array);

  /// `siemens` and `ratio` are [rows, cols]; conductances are finite and >= 0 [S]. ratio[i, j] is the reading over the
  /// supply while both lines of the taxel in row i and column j are selected.
  void ratios(std::span<const double> siemens, std::span<double> ratio) const;

  /// The same where the taxels are under these forces [rows, cols], which Readout::film follows. Without them the film
  /// is unloaded.
  void ratios(std::span<const double> siemens, std::span<const double> newtons, std::span<double> ratio) const;

  /// The same in single precision: a relative error of about 1e-6. Faster for a divider with grounded idle rows of up
  /// to 64x64 taxels (docs/reasons/inversions.md has the times).
  void ratios(std::span<const float> siemens, std::span<float> ratio) const;

 private:
  explicit ReadoutCircuit(const ArrayDescription& array);

  Readout readout_;
  std::size_t rows_;
  std::size_t cols_;
  std::vector<double> unloaded_n_;  // of arrays with a film [taxels]
  bool is_grounded_divider_;        // that grounded_divider_ratios() takes
};

}  // namespace dermis::learn::simulation
