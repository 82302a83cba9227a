// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "dermis/touch/compensation/circuit_model.hpp"
#include "dermis/touch/frames/array_description.hpp"
#include "touch/compensation/film_follower.hpp"

namespace dermis::touch::compensation {

/// A reading and its taxel on the scale x(g) = asinh(g / 2 g_n). It is the logarithm of a conductance above the noise
/// of its reading g_n, proportional to it below, and 0 at 0 S. A reading I_ds (current over the supply) stands there as
/// the conductance without crosstalk, y = I / (1 - (rho_d + rho_s) I), the textbook divider.
struct ReadingScale {
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

/// No taxel conducts more [S].
inline constexpr double kMostSiemens = 1e3;

/// A circuit with its taxels and readings on that scale, beside the readings of a frame.
class ScaledCircuit {
 public:
  /// `model` is of `array`. A film follows the taxels by `references`.
  ScaledCircuit(const ArrayDescription& array, CircuitModel model, const ReferenceConductances& references);

  /// See CrosstalkInversion.
  void hold_film(const FilmConductances& film) noexcept;
  [[nodiscard]] bool has_film() const noexcept { return film_.any(); }

  /// The frame to compare with; `ratio` is to outlive the comparison. Where it is not a number, the taxel is wanted at
  /// `siemens`, and its measured() is that.
  void set_frame(std::span<const double> ratio, std::span<const double> siemens) noexcept;

  /// The taxels, to be set before solve().
  [[nodiscard]] std::vector<double>& x() noexcept { return x_; }
  [[nodiscard]] const std::vector<double>& x() const noexcept { return x_; }
  void solve() noexcept;

  [[nodiscard]] const std::vector<ReadingScale>& readings() const noexcept { return readings_; }
  [[nodiscard]] CircuitModel& model() noexcept { return model_; }
  /// x of the readings of the frame.
  [[nodiscard]] const std::vector<double>& measured() const noexcept { return measured_; }
  /// The taxels [S]; solve() sets them from x.
  [[nodiscard]] std::vector<double>& siemens() noexcept { return siemens_; }
  [[nodiscard]] const std::vector<double>& siemens() const noexcept { return siemens_; }
  /// The taxel has no reading.
  [[nodiscard]] bool is_kept(std::size_t taxel) const noexcept { return std::isnan(ratio_[taxel]); }
  /// x of the readings of the frame less x of those of the circuit; what a taxel without a reading lacks.
  [[nodiscard]] const std::vector<double>& misfit() const noexcept { return misfit_; }

  /// The root of the sum of squares of max(misfit, -x).
  [[nodiscard]] double merit() const noexcept;
  /// See InversionResult.
  [[nodiscard]] double residual_ratio() const noexcept;
  /// The largest reading of the frame, without sign.
  [[nodiscard]] double largest_ratio() const noexcept;

 private:
  std::vector<ReadingScale> readings_;
  CircuitModel model_;
  FilmFollower film_;
  std::span<const double> ratio_;
  std::vector<double> measured_;
  std::vector<double> x_;
  std::vector<double> siemens_;
  std::vector<double> misfit_;
};

}  // namespace dermis::touch::compensation
