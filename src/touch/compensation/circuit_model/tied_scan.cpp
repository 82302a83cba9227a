// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/circuit_model/tied_scan.hpp"

namespace dermis::touch::compensation {

TiedScan::TiedScan(const ScannedLines& lines, const LineNetwork& network)
    : CircuitScan(lines), responses_(lines, network), drops_(lines.driven(), lines.sensed(), lines.taxels()) {}

void TiedScan::solve() noexcept {
  responses_.solve();
  drops_.forward = responses_.driven_drops().rowwise() + responses_.offset_drops();
  drops_.adjoint = responses_.sensed_drops();
  drops_.prepare_sums();
  lines().for_each_reading([&](std::size_t d, std::size_t s, std::size_t) {
    const std::size_t line = lines().driven() + s;
    current(d, s) = responses_.current(line, d) + responses_.offset_current(line);
  });
}

double TiedScan::current_by_resistor(std::size_t driven, std::size_t sensed, std::size_t line) const noexcept {
  return (responses_.current(line, driven) + responses_.offset_current(line)) *
         responses_.current(line, lines().driven() + sensed);
}

void TiedScan::derive(std::size_t driven, std::size_t sensed, std::size_t first, std::span<double> out) const noexcept {
  const double gain = lines().sensed_head(sensed).gain;
  drops_.derive(driven, sensed, gain, first, {out.data(), at(out.size())});
}

void TiedScan::multiply_taxel_jacobian(std::span<const double> change, std::span<double> product) noexcept {
  const Matrix& sums = drops_.sum(change);
  lines().for_each_reading([&](std::size_t d, std::size_t s, std::size_t reading) {
    product[reading] = -lines().sensed_head(s).gain * sums(at(d), at(s));
  });
}

}  // namespace dermis::touch::compensation
