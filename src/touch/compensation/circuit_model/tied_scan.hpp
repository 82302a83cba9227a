// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include "touch/compensation/circuit_model/circuit_scan.hpp"
#include "touch/compensation/circuit_model/drop_pairs.hpp"
#include "touch/compensation/circuit_model/line_responses.hpp"

namespace dermis::touch::compensation {

/// All lines stay tied: scans differ in their sources alone and superpose.
class TiedScan final : public CircuitScan {
 public:
  TiedScan(const ScannedLines& lines, const LineNetwork& network);

  void solve() noexcept override;
  [[nodiscard]] double current_by_resistor(std::size_t driven, std::size_t sensed,
                                           std::size_t line) const noexcept override;
  void multiply_taxel_jacobian(std::span<const double> change, std::span<double> product) noexcept override;

 private:
  void derive(std::size_t driven, std::size_t sensed, std::size_t first, std::span<double> out) const noexcept override;

  LineResponses responses_;
  DropPairs drops_;
};

}  // namespace dermis::touch::compensation
