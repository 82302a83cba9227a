// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/axis.hpp"

namespace dermis::touch::compensation {

/// The nodal equations of a circuit with faults in it. Row and column lines are nodes, and every fault changes a
/// conductance between two nodes, 0 V or the supply. Ideal drivers and virtual grounds are conductances far above all
/// others. Their errors cancel in the difference of two circuits, which is all that FaultInversion uses. Lines and
/// switches have no resistance of their own.
class LumpedCircuit {
 public:
  /// `array` has a known circuit that is not `none`.
  explicit LumpedCircuit(const ArrayDescription& array);

  /// The film of an array that has one, at first an unloaded one. Allocates nothing.
  void set_film(const FilmConductances& film) noexcept;

  /// Takes all faults away.
  void restore();

  void open_line(Axis axis, std::size_t line);
  void ground_line(Axis axis, std::size_t line);
  void join_lines(Axis axis, std::size_t line);  ///< With the next row or column.
  void join_crossing(std::size_t taxel);         ///< Its row with its column.
  void tie_column_to_supply(std::size_t col);
  void set_drive_ohm(std::size_t driven_line, double ohm);

  /// Readings over the supply [rows, cols]. Allocates nothing.
  void solve(std::span<const double> siemens, std::span<double> ratio) noexcept;

 private:
  [[nodiscard]] double ground_gain() const noexcept;
  [[nodiscard]] bool rows_float() const noexcept;
  [[nodiscard]] bool one_loaded() const noexcept;
  [[nodiscard]] std::size_t node_of(Axis axis, std::size_t line) const noexcept {
    return axis == Axis::row ? line : array_.rows + line;
  }
  [[nodiscard]] std::size_t driven_node(std::size_t line) const noexcept { return node_of(driven_, line); }
  [[nodiscard]] std::size_t sensed_node(std::size_t line) const noexcept { return node_of(crossing(driven_), line); }
  void assemble(std::span<const double> siemens) noexcept;
  void add_drivers(std::size_t driven) noexcept;
  void add_sources(std::size_t scan, std::size_t driven) noexcept;
  void add_probes(std::size_t first) noexcept;
  void connect(std::size_t a, std::size_t b, double siemens) noexcept;
  void factorise() noexcept;
  void substitute(std::size_t columns) noexcept;
  void read(std::size_t scan, std::size_t driven, std::size_t first_probe, std::span<double> ratio) const noexcept;

  ArrayDescription array_;
  Axis driven_;
  std::size_t nodes_;                   // rows, then columns
  std::vector<double> film_siemens_;    // from every node to the next one [nodes]
  std::vector<double> drive_siemens_;   // [driven lines]
  std::vector<double> load_siemens_;    // [sensed lines]
  std::vector<double> supply_siemens_;  // from every node to the supply [nodes]
  std::vector<double> joint_siemens_;   // from every node to the next one [nodes]
  std::vector<std::size_t> crossings_;  // taxels whose row and column are joined
  std::vector<double> ground_siemens_;  // from every node to 0 V, beside driver and load [nodes]
  std::vector<bool> is_open_;           // [nodes]
  std::size_t right_columns_;
  std::vector<double> matrix_;     // [nodes, nodes], the lower triangle; then its Cholesky factor
  std::vector<double> assembled_;  // the same without drivers
  std::vector<double> right_;      // [nodes, right_columns]: sources, then probes; then the voltages
};

/// Reading of a row (or column) over that of the next one where both are one node. Grounded idle rows work against the
/// driven one through their drivers.
[[nodiscard]] double ratio_of_shorted_lines(const ArrayDescription& array, Axis axis, std::size_t line) noexcept;

}  // namespace dermis::touch::compensation
