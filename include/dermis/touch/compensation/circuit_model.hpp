// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>
#include <span>

#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::touch::compensation {

/// Any readout circuit as nodal equations: its readings and their exact derivatives, in double precision. The inversion
/// by Newton's method, the fit of unknown resistances and the Cramer-Rao bound all use it. Let u be the node voltages
/// while line k is driven. Let w be the response of the reading j to a current into each node (adjoint). A conductance
/// g between the nodes a and b then changes the reading by
///
///   d T_kj / d g = -(w_a - w_b) (u_a - u_b)            formula (5) of docs/reasons/derivations-circuits.md
///
/// Star-mesh elimination finds the potentials without a subtraction. So readings are right to a few roundings, however
/// far apart the conductances are. Readings have their taxel's row-major index. Not thread-safe: one per thread.
class CircuitModel {
 public:
  /// Errors: an invalid array, `none`, a circuit with unknown resistances, or an array that is too large. Every circuit
  /// of 128x128 taxels is solved, with resistive lines read between two terminals 64x64.
  [[nodiscard]] static Result<CircuitModel> create(const ArrayDescription& array);
  CircuitModel(CircuitModel&&) noexcept;
  CircuitModel& operator=(CircuitModel&&) noexcept;
  ~CircuitModel();

  /// Solves the circuit for conductances [rows, cols], each finite and >= 0 [S]. Allocates nothing after the first
  /// call.
  void solve(std::span<const double> siemens) noexcept;

  /// Replaces the resistances of the drivers and loads [ohm], sizes driven_lines() and sensed_lines().
  void set_resistors(std::span<const double> drive_ohm, std::span<const double> load_ohm);

  /// The film of an array that has one (Readout::film), at first an unloaded one. Along a line with resistance that is
  /// spread evenly, and what it conducts beyond as the taxels do; derivatives leave out this share. Allocates nothing.
  void set_film(const FilmConductances& film) noexcept;

  /// Readings over the supply at the last solution [rows, cols].
  [[nodiscard]] std::span<const double> ratio() const noexcept;

  /// Share of the supply that its own resistance leaves during each reading of the last solution [rows, cols]. It is
  /// 1/(1 + supply_ohm Y), where the driven line takes Y of an ideal one [S].
  [[nodiscard]] std::span<const double> supply_left() const noexcept;

  /// d ratio / d siemens at the last solution, [reading, taxel], row-major [ohm]. The derivatives take the resistance
  /// of a supply that idle lines do not share for a loss of each reading on its own.
  void taxel_jacobian(std::span<double> jacobian) const noexcept;

  /// Its diagonal: d ratio / d siemens of the same taxel [rows, cols] [ohm].
  void own_derivatives(std::span<double> derivatives) const noexcept;

  /// product = taxel_jacobian change without the matrix: the change of every reading [rows, cols] for a change of every
  /// taxel [rows, cols] [S]. Allocates nothing.
  void multiply_taxel_jacobian(std::span<const double> change, std::span<double> product) noexcept;

  /// d ratio / d drive_ohm [reading, driven line] and d ratio / d load_ohm [reading, sensed line], row-major [1/ohm].
  void drive_jacobian(std::span<double> jacobian) const noexcept;
  void load_jacobian(std::span<double> jacobian) const noexcept;

 private:
  struct Implementation;
  explicit CircuitModel(std::unique_ptr<Implementation> implementation);
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace dermis::touch::compensation
