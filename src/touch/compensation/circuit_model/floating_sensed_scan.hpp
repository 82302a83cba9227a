// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <vector>

#include "touch/compensation/circuit_model/circuit_scan.hpp"
#include "touch/compensation/circuit_model/drop_pairs.hpp"
#include "touch/compensation/circuit_model/line_responses.hpp"

namespace dermis::touch::compensation {

/// The sensed lines float but the one that is read; the driven ones stay tied. No amplifier holds a line, so no
/// offsets.
class FloatingSensedScan final : public CircuitScan {
 public:
  FloatingSensedScan(const ScannedLines& lines, const LineNetwork& network);

  void solve() noexcept override;
  [[nodiscard]] double current_by_resistor(std::size_t driven, std::size_t sensed,
                                           std::size_t line) const noexcept override;
  void multiply_taxel_jacobian(std::span<const double> change, std::span<double> product) noexcept override;

 private:
  void sense(std::size_t sensed) noexcept;
  void derive(std::size_t driven, std::size_t sensed, std::size_t first, std::span<double> out) const noexcept override;

  LineResponses responses_;
  DropPairs drops_;
  std::vector<double> loop_siemens_;  // through the rho of the line that the scan ties [sensed]
  Matrix squares_;                    // what that line takes away [sensed, taxels]
  Eigen::VectorXd square_sums_;       // over the taxels [sensed]
};

}  // namespace dermis::touch::compensation
