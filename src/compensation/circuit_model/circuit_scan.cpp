// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "compensation/circuit_model/circuit_scan.hpp"

#include "compensation/circuit_model/floating_driven_scan.hpp"
#include "compensation/circuit_model/floating_sensed_scan.hpp"
#include "compensation/circuit_model/tied_scan.hpp"
#include "compensation/circuit_model/two_terminal_scan.hpp"

namespace dermis::compensation {

std::unique_ptr<CircuitScan> make_circuit_scan(const ScannedLines& lines, const LineNetwork& network) {
  if (lines.driven_are_tied() && lines.sensed_are_tied()) return std::make_unique<TiedScan>(lines, network);
  if (lines.sensed_are_tied()) return std::make_unique<FloatingDrivenScan>(lines, network);
  if (lines.driven_are_tied()) return std::make_unique<FloatingSensedScan>(lines, network);
  return std::make_unique<TwoTerminalScan>(lines, network);
}

}  // namespace dermis::compensation
