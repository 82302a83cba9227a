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

template <typename Newtons>
void find(const Film& film, Newtons newtons, FilmConductances& conductances) {
  auto& [between_rows, between_cols] = conductances;
  const std::size_t rows = between_rows.size() + 1;
  const std::size_t cols = between_cols.size() + 1;
  std::fill(between_rows.begin(), between_rows.end(), 1.0 / film.unloaded_ohm);
  std::fill(between_cols.begin(), between_cols.end(), 1.0 / film.unloaded_ohm);
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t col = 0; col < cols; ++col) {
      const auto at = [&](std::size_t i, std::size_t j) { return static_cast<double>(newtons[i * cols + j]); };
      if (row + 1 < rows) between_rows[row] += film.rise(at(row, col), at(row + 1, col));
      if (col + 1 < cols) between_cols[col] += film.rise(at(row, col), at(row, col + 1));
    }
  }
}

}  // namespace

bool Film::is_unknown() const noexcept {
  return std::isnan(unloaded_ohm) || std::isnan(loaded_ohm);
}

double Film::rise(double newtons, double other_newtons) const noexcept {
  const double load = 0.5 * (at_least_zero(newtons) + at_least_zero(other_newtons)) / loaded_newtons;
  if (load == 0.0) return 0.0;
  return (1.0 / loaded_ohm - 1.0 / unloaded_ohm) * std::pow(std::min(load, 1.0), kExponent);
}

void FilmConductances::set(const Film& film, std::span<const double> newtons) noexcept {
  find(film, newtons, *this);
}

void FilmConductances::set(const Film& film, std::span<const float> newtons) noexcept {
  find(film, newtons, *this);
}

}  // namespace dermis
