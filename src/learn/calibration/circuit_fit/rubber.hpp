// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "learn/calibration/circuit_fit/circuit_frames.hpp"

namespace dermis::learn::calibration {

inline constexpr Eigen::Index kFreeTerms = 3;    // of a pressed law: level, exponent, temperature
inline constexpr Eigen::Index kShapeTerms = 4;   // x^2, x^3, t^2, t x: alike in all taxels of a piece of rubber
inline constexpr Eigen::Index kCommonTerms = 7;  // x^4, x^5, x^6, t x^2, t x^3, t^2 x, a resistance in series: the same
inline constexpr Eigen::Index kPressedTerms = kFreeTerms + kShapeTerms;
inline constexpr Eigen::Index kSheetTerms = kShapeTerms + kCommonTerms;

/// The conductance of a taxel, over a reference conductance of the array. t: temperature, x: logarithm of the force,
/// both scaled to about [-1, 1].
struct TaxelLaw {
  Eigen::VectorXd unloaded;  ///< u = a + b t + c t^2; empty: never seen idle.
  Eigen::VectorXd pressed;   ///< ln(g - u) = a + b x + c t + d x^2 + e x^3 + f t^2 + g t x; empty: never pressed.
  bool is_readable = false;  ///< When idle, in any circuit: its readings stand above the noise that is cut at 0.
};

/// x = (ln F - centre) / half_span.
struct ForceScale {
  double centre = 0.0;
  double half_span = 1.0;
  [[nodiscard]] double log_force(double newtons) const;
};

/// A piece of rubber: the laws of all its taxels.
struct Rubber {
  double reference_siemens = 0.0;  ///< Conductances of the laws are multiples of it.
  ForceScale force_scale;
  Eigen::Index unloaded_terms = 1;  ///< 3 where temperature is known.
  std::vector<TaxelLaw> laws;
  /// Mean of the shapes; common terms of all pressed laws.
  Eigen::VectorXd sheet = Eigen::VectorXd::Zero(kSheetTerms);
};

/// Rubber whose laws are not known yet.
[[nodiscard]] Rubber unknown_rubber(const CircuitFrames& frames, std::size_t taxels, double reference_siemens);

[[nodiscard]] Eigen::VectorXd unloaded_basis(const Rubber& rubber, double temperature);

[[nodiscard]] Eigen::VectorXd pressed_basis(double x, double t);

/// The terms that all taxels of a piece of rubber share. The laws cannot distinguish a contact resistance in series
/// with each taxel from the mean of the drivers. Without its column the fit would take a law that is not quite a cubic
/// for it. `excess`: conductance over the unloaded one.
[[nodiscard]] Eigen::VectorXd common_basis(double x, double t, double excess);

}  // namespace dermis::learn::calibration
