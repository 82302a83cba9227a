// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/circuit_model/circuit_scan.hpp"

#include "touch/compensation/circuit_model/floating_driven_scan.hpp"
#include "touch/compensation/circuit_model/floating_sensed_scan.hpp"
#include "touch/compensation/circuit_model/tied_scan.hpp"
#include "touch/compensation/circuit_model/two_terminal_scan.hpp"

namespace dermis::touch::compensation {

CircuitScan::CircuitScan(const ScannedLines& lines)
    : lines_(lines), currents_(at(lines.driven()), at(lines.sensed())) {}

void CircuitScan::taxel_jacobian(std::span<double> jacobian) const noexcept {
  lines_.for_each_reading([&](std::size_t driven, std::size_t sensed, std::size_t reading) {
    derive(driven, sensed, 0, jacobian.subspan(reading * lines_.taxels(), lines_.taxels()));
  });
}

void CircuitScan::own_derivatives(std::span<double> derivatives) const noexcept {
  lines_.for_each_reading([&](std::size_t driven, std::size_t sensed, std::size_t reading) {
    derive(driven, sensed, reading, derivatives.subspan(reading, 1));
  });
}

std::unique_ptr<CircuitScan> make_circuit_scan(const ScannedLines& lines, const LineNetwork& network) {
  if (lines.driven_are_tied() && lines.sensed_are_tied()) return std::make_unique<TiedScan>(lines, network);
  if (lines.sensed_are_tied()) return std::make_unique<FloatingDrivenScan>(lines, network);
  if (lines.driven_are_tied()) return std::make_unique<FloatingSensedScan>(lines, network);
  return std::make_unique<TwoTerminalScan>(lines, network);
}

}  // namespace dermis::touch::compensation
