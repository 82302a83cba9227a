// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <span>
#include <vector>

#include "touch/compensation/krylov_solver.hpp"
#include "touch/compensation/scaled_circuit.hpp"

namespace dermis::touch::compensation {

/// The linear equations of a step of Newton's method, where a circuit stands.
///
/// They are solved by GMRES. They are scaled by the units of y and by the derivative of each reading by its own taxel.
/// So they are so well conditioned that 5 to 60 products with J suffice, whatever the circuit. For lines of no
/// resistance a product takes rows^2 cols^2 multiplications, an LU decomposition rows^3 cols^3 / 3.
class NewtonEquations {
 public:
  /// `circuit` is to outlive it.
  explicit NewtonEquations(ScaledCircuit& circuit);

  /// Sets the equations up where the circuit was solved last. Taxels with x + misfit <= 0 are held at 0 S,
  /// and those without a reading where they are wanted.
  void set_up() noexcept;
  /// Asks for all taxels, with these right sides, in x of the readings.
  void release_taxels() noexcept;
  [[nodiscard]] std::vector<double>& right() noexcept { return right_; }

  /// `damping` is added to the diagonal, as Levenberg and Marquardt do; `accuracy` is relative to the right sides.
  void solve(double damping, double accuracy) noexcept;

  /// The change of every taxel, over its column_scale() [S].
  [[nodiscard]] const std::vector<double>& solution() const noexcept { return solution_; }
  /// The change of x that the solution asks for.
  [[nodiscard]] double change(std::size_t taxel) const noexcept;
  /// d x of a reading / d ratio.
  [[nodiscard]] const std::vector<double>& row_scale() const noexcept { return row_scale_; }
  /// The unit of a taxel in the equations [S].
  [[nodiscard]] const std::vector<double>& column_scale() const noexcept { return column_scale_; }

 private:
  ScaledCircuit& circuit_;
  KrylovSolver solver_;
  std::vector<double> own_slope_;
  std::vector<double> row_scale_;
  std::vector<double> column_scale_;
  std::vector<double> wanted_;  // x of a taxel that is held
  std::vector<double> right_;
  std::vector<double> solution_;
  std::vector<double> scaled_;
  std::vector<bool> held_;
};

}  // namespace dermis::touch::compensation
