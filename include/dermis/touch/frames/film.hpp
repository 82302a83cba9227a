// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace dermis {

/// One piece of film or rubber over all lines also conducts from each electrode to its neighbours. Between two
/// neighbouring rows, and between two neighbouring columns, it conducts
///
///   1/unloaded_ohm + sum of (1/loaded_ohm - 1/unloaded_ohm) min(F / loaded_newtons, 1)^0.9
///
/// over all pairs of neighbouring taxels on the two lines, F the mean of their two forces. The exponent is that of a
/// taxel of such films: shared/research/literature.md. Both resistances may be kFitOhm.
struct Film {
  double unloaded_ohm = 0.0;     ///< Between two neighbouring lines with nothing on the sheet, > 0.
  double loaded_ohm = 0.0;       ///< The same where one pair of taxels is loaded, > 0, at most unloaded_ohm.
  double loaded_newtons = 20.0;  ///< On each of these two, > 0.

  [[nodiscard]] bool is_unknown() const noexcept;  ///< A resistance is kFitOhm.
  [[nodiscard]] bool is_constant() const noexcept { return loaded_ohm == unloaded_ohm; }
  /// By how much more it conducts with two neighbouring taxels under these forces, 0 or more [S].
  [[nodiscard]] double rise(double newtons, double other_newtons) const noexcept;
};

/// A film as it conducts from each row to the next [rows - 1] and from each column to the next [cols - 1] [S].
struct FilmConductances {
  FilmConductances(std::size_t rows, std::size_t cols)
      : between_rows(rows > 0 ? rows - 1 : 0), between_cols(cols > 0 ? cols - 1 : 0) {}

  /// The taxels are under these forces [rows, cols]; less than 0 and NaN are 0. Allocates nothing.
  void set(const Film& film, std::span<const double> newtons) noexcept;
  void set(const Film& film, std::span<const float> newtons) noexcept;

  std::vector<double> between_rows;
  std::vector<double> between_cols;
};

/// A point of the law of a sheet's taxels: all have one curve, each on its own scale.
struct LoadPoint {
  double share = 0.0;    ///< In the conductance under one same force, both above the unloaded one.
  double newtons = 0.0;  ///< Under which it conducts this.
};

}  // namespace dermis
