// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "compensation/dense_inverse.hpp"
#include "compensation/floating_rows.hpp"
#include "compensation/krylov_solver.hpp"
#include "dermis/compensation/circuit_model.hpp"
#include "dermis/compensation/crosstalk.hpp"
#include "dermis/core/random.hpp"

namespace dermis::compensation {

/// Any readout circuit, by Newton's method with the exact Jacobian J of CircuitModel (formula (5) of
/// docs/derivations.md).
///
/// Both the readings and the taxels are taken on the scale x(g) = asinh(g / 2 g_n): the logarithm of a conductance
/// above the noise of its reading g_n, proportional to it below, and 0 at 0 S. A reading I_ds (current over the supply)
/// stands there as the conductance that it would mean without crosstalk, y = I / (1 - (rho_d + rho_s) I), the textbook
/// divider. With it, Newton's method converges from the textbook estimate in about 14 steps (four and five decades of
/// taxels, 2x2 to 64x64, every circuit).
///
/// Non-negative: wanted are x >= 0 with r = x(y measured) - x(y of the circuit) = 0, or r < 0 where x = 0, that is
/// max(r, -x) = 0. Its Newton step holds those taxels at 0 S for which x + r <= 0 and solves for the others. Steps are
/// bounded, halved, and then damped as Levenberg and Marquardt do, until |max(r, -x)| falls.
///
/// The equations of a step are solved by GMRES. In units of y and divided by the derivative of each reading by its own
/// taxel they are so well conditioned that 5 to 60 products with J suffice, whatever the circuit; for lines of no
/// resistance a product takes rows^2 cols^2 multiplications, an LU decomposition rows^3 cols^3 / 3.
///
/// Two solutions: a divider with grounded idle rows whose drivers and loads are large beside its taxels (row and column
/// together) can have two positive arrays with the same readings, apart by a fold where det(J) = 0; about 2 of 100
/// random arrays of 16x16 do, with taxels from 200 ohm, drivers to 200 ohm and loads to 10 kohm. The start from the
/// textbook estimate then gives the array on the idle one's side of the fold, det(J) > 0.
///
/// Floating rows of lines without resistance are solved by FloatingRows; Newton's method starts from there where that
/// is not to the tolerance, and anew where it does not settle.
///
/// Floating lines read every taxel through all others. What noise becomes there is in the nature of the circuit: at
/// 16x16 the relative noise of a reading grows by 25 to 104 (rms, two terminals), of a single one by thousands.
class NewtonInversion final : public CrosstalkInversion {
 public:
  /// `model` is of `array`.
  NewtonInversion(const ArrayDescription& array, CircuitModel model, double tolerance_ratio,
                  const InversionOptions& options);

  [[nodiscard]] InversionResult invert(std::span<const double> ratio, std::span<double> siemens) noexcept override;
  void forget() noexcept override;
  void propagate_noise(double sigma_ratio, std::span<double> sigma_siemens) noexcept override;
  [[nodiscard]] double siemens_per_ratio() const noexcept override;

 private:
  struct Reading {
    double gain = 1.0;    // d ratio / d current [ohm]
    double offset = 0.0;  // ratio at no current
    double series = 0.0;  // rho_d + rho_s [ohm]
    double noise = 0.0;   // g_n [S]
    std::size_t driver = 0;
    double scale = 0.0;  // g_n, and the size of a reading below 0, which an amplifier's offset may cause [S]
    [[nodiscard]] double apparent_siemens(double ratio) const noexcept;  // y
    [[nodiscard]] double scaled(double ratio) const noexcept;
    [[nodiscard]] double scaled_siemens(double siemens) const noexcept;
    [[nodiscard]] double slope(double ratio) const noexcept;       // d scaled / d ratio
    [[nodiscard]] double open_slope(double ratio) const noexcept;  // d ratio / d siemens without crosstalk
    [[nodiscard]] double siemens(double x) const noexcept;
    [[nodiscard]] double siemens_slope(double x) const noexcept;
  };

  [[nodiscard]] bool solve() noexcept;
  void start(bool from_last_frame) noexcept;
  void start_at_siemens() noexcept;
  [[nodiscard]] bool iterate(int bold_steps) noexcept;
  [[nodiscard]] bool step(double allowed_rise) noexcept;
  void scale_equations() noexcept;
  void solve_equations(double accuracy) noexcept;
  void find_drive_slopes() noexcept;
  void add_exact_variance(double sigma_ratio, std::span<double> variance) noexcept;
  void add_exact_driver_variance(std::span<double> variance) noexcept;
  void add_sampled_variance(double sigma_ratio, std::span<double> variance) noexcept;
  void draw_drivers(Random& random) noexcept;
  [[nodiscard]] double alone(std::size_t taxel) const noexcept;
  [[nodiscard]] double moved(std::size_t taxel, double x, double change) const noexcept;
  void solve_at(std::span<const double> x) noexcept;
  [[nodiscard]] double merit() const noexcept;
  [[nodiscard]] double residual_ratio() const noexcept;

  std::vector<Reading> readings_;
  CircuitModel model_;
  KrylovSolver solver_;
  std::unique_ptr<DenseInverse> inverse_;        // of small arrays, where noise is not sampled
  std::unique_ptr<FloatingRows> floating_rows_;  // of arrays that it inverts: the start, mostly the solution
  double tolerance_;
  int most_steps_;
  int steps_left_ = 0;  // of this frame
  std::span<const double> ratio_;
  std::vector<double> measured_;  // x of the readings
  std::vector<double> x_;         // of the taxels
  std::vector<double> last_x_;
  std::vector<double> scaled_;
  std::vector<double> siemens_;
  std::vector<double> misfit_;  // r at siemens_
  std::vector<double> own_slope_;
  std::vector<double> row_scale_;
  std::vector<double> column_scale_;
  std::vector<double> right_;
  std::vector<double> solution_;
  std::vector<double> change_;
  std::vector<bool> held_;
  double damping_ = 0.0;
  std::vector<double> drive_error_ohm_;  // [driven lines]; empty: exact, or not counted
  double drive_error_correlation_;
  std::vector<double> drive_slope_;   // d x of a reading / d ohm [taxels, driven lines]
  std::vector<double> drive_change_;  // what it makes of the taxels, in units of a step's equations
  std::vector<double> drawn_ohm_;     // errors of the drivers [driven lines]
  bool has_last_frame_ = false;
  std::vector<double> last_shift_;  // x - measured of the last solved frame
};

}  // namespace dermis::compensation
