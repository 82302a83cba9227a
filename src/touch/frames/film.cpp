// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/frames/film.hpp"

#include <algorithm>
#include <cmath>

namespace dermis {
namespace {

constexpr double kExponent = 0.9;

double at_least_zero(double newtons) {
  return newtons > 0.0 ? newtons : 0.0;
}

}  // namespace

bool Film::is_unknown() const noexcept {
  return std::isnan(unloaded_ohm) || std::isnan(loaded_ohm);
}

double Film::siemens(double newtons, double other_newtons) const noexcept {
  const double load = 0.5 * (at_least_zero(newtons) + at_least_zero(other_newtons)) / loaded_newtons;
  const double rise = 1.0 / loaded_ohm - 1.0 / unloaded_ohm;
  return 1.0 / unloaded_ohm + (load > 0.0 ? rise * std::pow(std::min(load, 1.0), kExponent) : 0.0);
}

void FilmConductances::set(const Film& film, std::span<const double> newtons) noexcept {
  const std::size_t rows = between_rows.size() + 1;
  const std::size_t cols = between_cols.size() + 1;
  std::fill(between_rows.begin(), between_rows.end(), 0.0);
  std::fill(between_cols.begin(), between_cols.end(), 0.0);
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t col = 0; col < cols; ++col) {
      const double own = newtons[row * cols + col];
      if (row + 1 < rows) between_rows[row] += film.siemens(own, newtons[(row + 1) * cols + col]);
      if (col + 1 < cols) between_cols[col] += film.siemens(own, newtons[row * cols + col + 1]);
    }
  }
}

}  // namespace dermis
