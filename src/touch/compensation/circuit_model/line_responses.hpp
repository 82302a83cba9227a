// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>

#include "touch/compensation/circuit_model/line_network.hpp"
#include "touch/compensation/circuit_model/matrix.hpp"
#include "touch/compensation/circuit_model/scanned_lines.hpp"

namespace dermis::touch::compensation {

/// The base network's response to each line alone, and to the offsets of the amplifiers, the source after those of the
/// lines. A tied line gets 1 V behind its rho, a floating one 1 A into its head.
class LineResponses {
 public:
  /// Both outlive this.
  LineResponses(const ScannedLines& lines, const LineNetwork& network);

  /// At the conductances that the network was eliminated with.
  void solve() noexcept;

  /// Turns the drops of a floating line from those for 1 A to those for 1 V behind its rho. Returns the admittance of
  /// the loop through it [S].
  double drive_floating_line(std::size_t line) noexcept;

  /// While `line` is scanned, another floating line may be without taxels. A first taxel on it would bring it to the
  /// potential of the taxel's other end: no drop.
  void clear_isolated_lines(std::size_t line, Matrix::RowXpr drops) const noexcept;

  /// Out of the head of a tied line.
  [[nodiscard]] double current(std::size_t line, std::size_t source) const noexcept {
    return current_(at(line), at(source));
  }
  [[nodiscard]] double offset_current(std::size_t line) const noexcept { return current(line, lines_.count()); }

  /// Row node less column node [sources, taxels].
  [[nodiscard]] const Matrix& drops() const noexcept { return drop_; }
  [[nodiscard]] auto driven_drops() const noexcept { return drop_.topRows(at(lines_.driven())); }
  [[nodiscard]] auto sensed_drops() const noexcept {
    return drop_.middleRows(at(lines_.driven()), at(lines_.sensed()));
  }
  [[nodiscard]] auto offset_drops() const noexcept { return drop_.row(at(lines_.count())); }

  /// The potential that the amplifiers' offsets leave at the head of a line.
  [[nodiscard]] double offset_potential(std::size_t line) const noexcept {
    return potential_(at(network_.head(line)), at(lines_.count()));
  }

 private:
  void find_potentials() noexcept;
  void find_currents() noexcept;
  void find_drops() noexcept;

  const ScannedLines& lines_;
  const LineNetwork& network_;
  LineNetwork::Potentials potential_;  // [nodes, sources]
  Matrix current_;                     // [lines, sources]
  Matrix drop_;                        // [sources, taxels]
};

}  // namespace dermis::touch::compensation
