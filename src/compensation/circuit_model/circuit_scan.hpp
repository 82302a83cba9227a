// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "compensation/circuit_model/line_network.hpp"
#include "compensation/circuit_model/matrix.hpp"
#include "compensation/circuit_model/scanned_lines.hpp"

namespace dermis::compensation {

/// How a circuit is read: one driven and one sensed line at a time. Every reading is an affine function of the current
/// I_ds that leaves sensed line s while line d is driven: r = gain_s I_ds + offset_s.
///
/// Where lines of one side at least stay tied, a scan ties one driven or one sensed line on top of the base network, a
/// rank-1 change of which the potentials are known already (Sherman-Morrison). By reciprocity (Tellegen) a conductance
/// g across the drops f of the scan and h of the response to 1 V behind rho_s moves the current by dI_ds/dg = -f h, and
/// rho_t with the currents i and k into the network moves it by dI_ds/drho_t = i k.
class CircuitScan {
 public:
  virtual ~CircuitScan() = default;

  /// All scans at the conductances that the network was eliminated with: potentials, currents, drops.
  virtual void solve() noexcept = 0;

  /// I_ds over the supply [driven, sensed].
  [[nodiscard]] virtual const Matrix& currents() const noexcept = 0;

  /// d I_ds / d rho of a line.
  [[nodiscard]] virtual double current_by_resistor(std::size_t driven, std::size_t sensed,
                                                   std::size_t line) const noexcept = 0;

  /// See CircuitModel.
  virtual void taxel_jacobian(std::span<double> jacobian) const noexcept = 0;
  virtual void own_derivatives(std::span<double> derivatives) const noexcept = 0;
  virtual void multiply_taxel_jacobian(std::span<const double> change, std::span<double> product) noexcept = 0;
};

/// Both outlive the scan.
[[nodiscard]] std::unique_ptr<CircuitScan> make_circuit_scan(const ScannedLines& lines, const LineNetwork& network);

/// jacobian [reading, taxel] from derive(driven, sensed, first, out): d reading / d taxel for the taxels from `first`.
template <typename Derive>
void fill_jacobian(const ScannedLines& lines, std::span<double> jacobian, const Derive& derive) {
  lines.for_each_reading([&](std::size_t driven, std::size_t sensed, std::size_t reading) {
    derive(driven, sensed, std::size_t{0}, jacobian.subspan(reading * lines.taxels(), lines.taxels()));
  });
}

/// Its diagonal.
template <typename Derive>
void fill_diagonal(const ScannedLines& lines, std::span<double> derivatives, const Derive& derive) {
  lines.for_each_reading([&](std::size_t driven, std::size_t sensed, std::size_t reading) {
    derive(driven, sensed, reading, derivatives.subspan(reading, 1));
  });
}

}  // namespace dermis::compensation
