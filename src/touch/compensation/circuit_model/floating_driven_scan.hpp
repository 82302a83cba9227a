// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <vector>

#include "touch/compensation/circuit_model/circuit_scan.hpp"
#include "touch/compensation/circuit_model/drop_pairs.hpp"
#include "touch/compensation/circuit_model/line_responses.hpp"

namespace dermis::touch::compensation {

/// The driven lines float but the one that is driven; the sensed ones stay tied.
class FloatingDrivenScan final : public CircuitScan {
 public:
  FloatingDrivenScan(const ScannedLines& lines, const LineNetwork& network);

  void solve() noexcept override;
  [[nodiscard]] double current_by_resistor(std::size_t driven, std::size_t sensed,
                                           std::size_t line) const noexcept override;
  void multiply_taxel_jacobian(std::span<const double> change, std::span<double> product) noexcept override;

 private:
  void drive(std::size_t driven) noexcept;
  [[nodiscard]] double source_volts(std::size_t driven) const noexcept;  // that its driver sees
  void derive(std::size_t driven, std::size_t sensed, std::size_t first, std::span<double> out) const noexcept override;

  const LineNetwork& network_;
  LineResponses responses_;
  DropPairs drops_;
  std::vector<double> loop_siemens_;  // through the rho of the line that the scan ties [driven]
  Matrix squares_;                    // what that line takes away [driven, taxels]
  Eigen::VectorXd square_sums_;       // over the taxels [driven]
};

}  // namespace dermis::touch::compensation
