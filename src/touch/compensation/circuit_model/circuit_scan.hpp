// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "touch/compensation/circuit_model/line_network.hpp"
#include "touch/compensation/circuit_model/matrix.hpp"
#include "touch/compensation/circuit_model/scanned_lines.hpp"

namespace dermis::touch::compensation {

/// How a circuit is read: one driven and one sensed line at a time. Every reading is an affine function of the current
/// I_ds that leaves sensed line s while line d is driven: r = gain_s I_ds + offset_s.
///
/// Where lines of one side at least stay tied, a scan ties one driven or one sensed line on top of the base network.
/// The potentials of this rank-1 change are known already (Sherman-Morrison). A conductance g moves the current by
/// dI_ds/dg = -f h, by reciprocity (Tellegen). Here f is the drop across g in the scan, and h that in the response to 1
/// V behind rho_s. And rho_t with the currents i and k into the network moves it by dI_ds/drho_t = i k.
class CircuitScan {
 public:
  /// `lines` are to outlive it.
  explicit CircuitScan(const ScannedLines& lines);
  CircuitScan(const CircuitScan&) = delete;
  CircuitScan& operator=(const CircuitScan&) = delete;
  virtual ~CircuitScan() = default;

  /// All scans at the conductances that the network was eliminated with: potentials, currents, drops.
  virtual void solve() noexcept = 0;

  /// I_ds over the supply [driven, sensed].
  [[nodiscard]] const Matrix& currents() const noexcept { return currents_; }

  /// d I_ds / d rho of a line.
  [[nodiscard]] virtual double current_by_resistor(std::size_t driven, std::size_t sensed,
                                                   std::size_t line) const noexcept = 0;

  /// See CircuitModel.
  void taxel_jacobian(std::span<double> jacobian) const noexcept;
  void own_derivatives(std::span<double> derivatives) const noexcept;
  virtual void multiply_taxel_jacobian(std::span<const double> change, std::span<double> product) noexcept = 0;

 protected:
  [[nodiscard]] const ScannedLines& lines() const noexcept { return lines_; }
  /// See currents(); solve() sets them.
  [[nodiscard]] double& current(std::size_t driven, std::size_t sensed) noexcept {
    return currents_(at(driven), at(sensed));
  }

  /// d reading / d siemens of as many taxels as `out` has, from `first` on.
  virtual void derive(std::size_t driven, std::size_t sensed, std::size_t first,
                      std::span<double> out) const noexcept = 0;

 private:
  const ScannedLines& lines_;
  Matrix currents_;
};

/// Both outlive the scan.
[[nodiscard]] std::unique_ptr<CircuitScan> make_circuit_scan(const ScannedLines& lines, const LineNetwork& network);

}  // namespace dermis::touch::compensation
