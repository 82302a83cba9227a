// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "touch/compensation/circuit_model/circuit_scan.hpp"

namespace dermis::touch::compensation {

/// All lines float but the two that a scan connects. The potentials of each scan are found anew, for 1 A from its
/// driven to its sensed line. Differences of the responses of single lines would lose parts of the array that hang on
/// each other by weak taxels only.
class TwoTerminalScan final : public CircuitScan {
 public:
  TwoTerminalScan(const ScannedLines& lines, const LineNetwork& network);

  void solve() noexcept override;
  [[nodiscard]] double current_by_resistor(std::size_t driven, std::size_t sensed,
                                           std::size_t line) const noexcept override;
  void multiply_taxel_jacobian(std::span<const double> change, std::span<double> product) noexcept override;

 private:
  void derive(std::size_t driven, std::size_t sensed, std::size_t first, std::span<double> out) const noexcept override;
  [[nodiscard]] double drop(std::size_t driven, std::size_t sensed, std::size_t taxel) const noexcept;
  /// The scan lies within one part of the array.
  [[nodiscard]] bool is_joined(std::size_t driven, std::size_t sensed) const noexcept;
  void number_parts() noexcept;

  const LineNetwork& network_;
  LineNetwork::Potentials potential_;  // [nodes, readings]
  Eigen::RowVectorXd square_sums_;     // over the taxels [readings]
  std::vector<std::size_t> part_;      // of the array in which a line is: its first line [lines]
  Matrix across_;                      // sums over the taxels from one part to another [lines, lines]
};

}  // namespace dermis::touch::compensation
