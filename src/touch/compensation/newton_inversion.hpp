// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "dermis/touch/compensation/circuit_model.hpp"
#include "dermis/touch/compensation/crosstalk.hpp"
#include "touch/compensation/floating_rows.hpp"
#include "touch/compensation/newton_equations.hpp"
#include "touch/compensation/newton_noise.hpp"
#include "touch/compensation/scaled_circuit.hpp"
#include "touch/compensation/step_budget.hpp"

namespace dermis::touch::compensation {

/// Any readout circuit, by Newton's method with the exact Jacobian J of CircuitModel (formula (5) of
/// docs/reasons/derivations-circuits.md).
///
/// Readings and taxels are on the scale x of ReadingScale. With it, Newton's method converges from the textbook
/// estimate in about 14 steps (four and five decades of taxels, 2x2 to 64x64, every circuit).
///
/// Non-negative: wanted are x >= 0 with r = x(y measured) - x(y of the circuit) = 0, or r < 0 where x = 0, that is
/// max(r, -x) = 0. Its Newton step holds those taxels at 0 S for which x + r <= 0 and solves for the others. Steps are
/// bounded, halved, and then damped as Levenberg and Marquardt do, until |max(r, -x)| falls.
///
/// Two solutions: a divider with grounded idle rows can have two positive arrays with the same readings, apart by a
/// fold where det(J) = 0. Its drivers and loads must be large beside its taxels (row and column together). About 2 of
/// 100 random arrays of 16x16 do, with taxels from 200 ohm, drivers to 200 ohm and loads to 10 kohm. The start from the
/// textbook estimate then gives the array on the idle one's side of the fold, det(J) > 0.
///
/// FloatingRows solves floating rows of lines without resistance. Newton's method starts from there where that is not
/// to the tolerance, and anew where it does not settle.
///
/// Floating lines read every taxel through all others. So it is in the nature of the circuit that noise grows. At 16x16
/// the relative noise of a reading grows by 25 to 104 (rms, two terminals), of a single one by thousands.
class NewtonInversion final : public CrosstalkInversion {
 public:
  /// `model` is of `array`.
  NewtonInversion(const ArrayDescription& array, CircuitModel model, double tolerance_ratio,
                  const InversionOptions& options);

  [[nodiscard]] InversionResult invert(std::span<const double> ratio, std::span<double> siemens) noexcept override;
  bool start_frame(Nanos time) noexcept override {
    budget_.start_frame(time);
    return !budget_.is_scarce();
  }
  void start_attempt(double share) noexcept override { budget_.start_attempt(share); }
  void hold_film(const FilmConductances& film) noexcept override;
  void forget() noexcept override;
  void propagate_noise(double sigma_ratio, std::span<double> sigma_siemens) noexcept override;
  [[nodiscard]] double siemens_per_ratio() const noexcept override;

 private:
  [[nodiscard]] bool solve(std::span<const double> ratio, std::span<const double> siemens) noexcept;
  void start(bool from_last_frame) noexcept;
  void start_at_siemens() noexcept;
  [[nodiscard]] bool iterate(int bold_steps) noexcept;
  [[nodiscard]] bool step(double allowed_rise) noexcept;
  [[nodiscard]] double moved(std::size_t taxel, double x, double change) const noexcept;

  ScaledCircuit circuit_;
  NewtonEquations equations_;
  DriverErrors driver_errors_;
  std::unique_ptr<NewtonNoise> noise_;
  std::unique_ptr<FloatingRows> floating_rows_;  // of arrays that it inverts: the start, mostly the solution
  double tolerance_;
  StepBudget budget_;  // in solutions of the circuit
  int most_steps_;
  int steps_left_ = 0;  // of this frame
  double damping_ = 0.0;
  std::vector<double> last_x_;
  std::vector<double> change_;
  bool has_last_frame_ = false;
  std::vector<double> last_shift_;  // x - measured of the last solved frame
};

}  // namespace dermis::touch::compensation
