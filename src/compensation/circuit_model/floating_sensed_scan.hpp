// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <vector>

#include "compensation/circuit_model/circuit_scan.hpp"
#include "compensation/circuit_model/drop_pairs.hpp"
#include "compensation/circuit_model/line_responses.hpp"

namespace dermis::compensation {

/// The sensed lines float but the one that is read; the driven ones stay tied. No amplifier holds a line, so no
/// offsets.
class FloatingSensedScan final : public CircuitScan {
 public:
  FloatingSensedScan(const ScannedLines& lines, const LineNetwork& network);

  void solve() noexcept override;
  [[nodiscard]] const Matrix& currents() const noexcept override { return currents_; }
  [[nodiscard]] double current_by_resistor(std::size_t driven, std::size_t sensed,
                                           std::size_t line) const noexcept override;
  void taxel_jacobian(std::span<double> jacobian) const noexcept override;
  void own_derivatives(std::span<double> derivatives) const noexcept override;
  void multiply_taxel_jacobian(std::span<const double> change, std::span<double> product) noexcept override;

 private:
  void sense(std::size_t sensed) noexcept;
  void derive(std::size_t driven, std::size_t sensed, std::size_t first, std::span<double> out) const noexcept;

  const ScannedLines& lines_;
  LineResponses responses_;
  DropPairs drops_;
  Matrix currents_;
  std::vector<double> loop_siemens_;  // through the rho of the line that the scan ties [sensed]
  Matrix squares_;                    // what that line takes away [sensed, taxels]
  Eigen::VectorXd square_sums_;       // over the taxels [sensed]
};

}  // namespace dermis::compensation
