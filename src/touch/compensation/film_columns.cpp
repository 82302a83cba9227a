// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/film_columns.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "dermis/touch/frames/processor_clones.hpp"

namespace dermis::touch::compensation {
namespace {

constexpr double kLeastShare = 1e-6;         // of the supply that a column leaves
constexpr double kLeak = 1e-18;              // from a column to ground, where none of its taxels conducts [S]
constexpr double kLeastLoadCurrent = 1e-18;  // over the supply [S]
constexpr double kMostColumnFall = 0.1;      // of the sum of a column in a step
constexpr int kEstimateSteps = 2;

double larger(double a, double b) {
  return a > b ? a : b;
}

/// By elimination from the first column on and back (Thomas), a row of the matrix at a time.
template <typename Real>
DERMIS_PROCESSOR_CLONES void divide(const GroundedRowsFilm& film, std::size_t cols, std::size_t stride, Real* matrix) {
  for (std::size_t col = 0; col < cols; ++col) {
    const auto scale = static_cast<Real>(film.scale[col] * film.part[col]);
    const auto from_left = static_cast<Real>(film.to_previous[col] * film.part[col]);
    Real* const row = matrix + col * stride;
    const Real* const before = col > 0 ? row - stride : row;
    const Real share = col > 0 ? from_left : Real{0};
#pragma omp simd
    for (std::size_t k = 0; k < stride; ++k) row[k] = scale * row[k] + share * before[k];
  }
  for (std::size_t col = cols - 1; col-- > 0;) {
    const auto share = static_cast<Real>(film.to_next[col] * film.part[col]);
    Real* const row = matrix + col * stride;
    const Real* const behind = row + stride;
#pragma omp simd
    for (std::size_t k = 0; k < stride; ++k) row[k] += share * behind[k];
  }
}

/// (c), all columns loaded: P_jj of what enters each column beside taxels without a reading.
void enter_columns(const GroundedRowsState& state, std::vector<double>& diagonal) {
  const GroundedRowsFilm& film = *state.film;
  for (std::size_t col = 0; col < state.cols; ++col) {
    const double to_film = film.to_next[col] + film.to_previous[col];
    double entering = (1.0 + to_film) * film.sums[col];
    if (col > 0) entering -= film.to_next[col - 1] * film.sums[col - 1];
    if (col + 1 < state.cols) entering -= film.to_previous[col + 1] * film.sums[col + 1];
    double leaving = film.sums[col];
    for (const auto& [row, kept_col, siemens] : state.kept) {
      if (kept_col != col) continue;
      const double* const current = &film.currents[row * state.stride + col + 1];
      leaving -= current[0];
      entering += siemens - (1.0 + to_film) * current[0];
      if (col > 0) entering += film.to_next[col - 1] * current[-1];
      if (col + 1 < state.cols) entering += film.to_previous[col + 1] * current[1];
    }
    const double ohm = state.column_ohm[col];
    diagonal[col] = 1.0 + to_film + ohm * std::max(entering, 0.0) / std::max(1.0 - ohm * leaving, kLeastShare);
  }
}

/// (c), one column loaded: u, and the b that it tells. No reading tells what kept taxels add to that.
DERMIS_PROCESSOR_CLONES void find_units(const GroundedRowsState& state, std::vector<double>& told) {
  GroundedRowsFilm& film = *state.film;
  const double* const ohm = state.column_ohm.data();
  const double* const sums = film.sums.data();
  const double* const weights = film.weights.data();
  const double* const drops = film.drops.data();
  const double* const kept_sums = film.kept_sums.data();
  const double* const kept_shares = film.kept_shares.data();
  const double* const inverse = film.inverse.data();
  double* const unit = film.unit.data();
  double* const doubt = film.doubt.data();
  double* const out = told.data();
#pragma omp simd
  for (std::size_t col = 0; col < state.stride; ++col) {
    const double weight = larger(weights[col], kLeastLoadCurrent);
    const double left = 1.0 - drops[col] / weight;
    const double drawn = larger(weight - kept_sums[col], kLeastLoadCurrent);
    const double kept = larger(left, kLeastShare) * kept_shares[col] / inverse[col];
    out[col] = larger(left - ohm[col] * (sums[col] - kept_sums[col]), kLeastShare) / (drawn + kept);
    unit[col] = kept > 0.0 ? (ohm[col] + out[col]) / larger(left, kLeastShare) : 1.0 / weight;
    doubt[col] = std::abs(inverse[col] + ohm[col] - left * unit[col]) / (ohm[col] + inverse[col]);
  }
}

/// A step of Newton's method towards column sums whose inverse has the diagonal `values`; it replaces them.
void step_to_inverse(const GroundedRowsFilm& film, std::size_t cols, std::vector<double>& values) {
  const std::vector<double>& b = film.inverse;
  for (std::size_t col = 0; col < cols; ++col) values[col] = b[col] * (b[col] / values[col] - 1.0);
  double before = 0.0;
  for (std::size_t col = 0; col < cols; ++col) {
    const bool is_last = col + 1 == cols;
    const double share = film.to_next[col] * film.part[col];
    const double error = values[col] - (is_last ? 0.0 : share * share * values[col + 1]);
    const double change = error / (film.part[col] * (b[col] + (is_last ? 0.0 : share * share * b[col + 1])));
    values[col] = std::max(film.column_sum[col] + change - before, kMostColumnFall * film.column_sum[col]);
    before = share * share * change;
  }
}

}  // namespace

void follow_film(GroundedRowsFilm& film) noexcept {
  const std::vector<double>& between = film.follower.film().between_cols;
  for (std::size_t col = 0; col < between.size(); ++col) {
    film.to_next[col] = film.scale[col] * between[col];
    film.to_previous[col + 1] = film.scale[col + 1] * between[col];
  }
}

void factorise_columns(GroundedRowsFilm& film) noexcept {
  double before = 0.0;
  for (std::size_t col = 0; col < film.part.size(); ++col) {
    const double own = (film.one_loaded ? kLeak : 1.0) + film.scale[col] * film.column_sum[col];
    film.diagonal[col] = own + film.to_next[col] + film.to_previous[col];
    const double to_ground = own + film.to_previous[col] * before;
    film.part[col] = 1.0 / (to_ground + film.to_next[col]);
    before = to_ground * film.part[col];
  }
  if (!film.one_loaded) return;
  double behind = 0.0;
  for (std::size_t col = film.part.size(); col-- > 0;) {
    const double share = film.to_next[col] * film.part[col];
    behind = film.inverse[col] = film.part[col] + share * share * behind;
  }
}

void find_columns(const GroundedRowsState& state, std::vector<double>& diagonal) noexcept {
  GroundedRowsFilm& film = *state.film;
  if (!film.one_loaded) return enter_columns(state, diagonal);
  find_units(state, diagonal);
  step_to_inverse(film, state.cols, diagonal);
  for (std::size_t col = 0; col < state.cols; ++col) diagonal[col] += film.to_next[col] + film.to_previous[col];
}

void estimate_columns(GroundedRowsState& state) noexcept {
  GroundedRowsFilm& film = *state.film;
  if (!film.one_loaded) return enter_columns(state, film.diagonal);
  film.column_sum = film.weights;
  for (int step = 0; step < kEstimateSteps; ++step) {
    factorise_columns(film);
    for (std::size_t col = 0; col < state.cols; ++col) {
      film.kept_shares[col] = state.kept_siemens[col] * film.inverse[col];
    }
    find_units(state, film.work);
    step_to_inverse(film, state.cols, film.work);
    std::copy_n(film.work.begin(), state.cols, film.column_sum.begin());
  }
  factorise_columns(film);
}

void weigh_columns(GroundedRowsFilm& film) noexcept {
  const std::size_t stride = film.unit.size();
  for (std::size_t col = 0; col < stride; ++col) {
    film.own[col] = film.diagonal[col] * film.unit[col];
    film.from_left[col] = col > 0 ? film.to_next[col - 1] * film.unit[col - 1] : 0.0;
    film.from_right[col] = col + 1 < stride ? film.to_previous[col + 1] * film.unit[col + 1] : 0.0;
  }
}

void divide_by_columns(const GroundedRowsState& state, std::vector<double>& matrix) noexcept {
  divide(*state.film, state.cols, state.stride, matrix.data());
}

void divide_by_columns(const GroundedRowsState& state, std::vector<float>& matrix) noexcept {
  divide(*state.film, state.cols, state.stride, matrix.data());
}

void divide_row(const GroundedRowsFilm& film, std::vector<double>& row) noexcept {
  for (std::size_t col = 0; col < row.size(); ++col) {
    row[col] = film.part[col] * (row[col] + (col > 0 ? film.to_next[col - 1] * row[col - 1] : 0.0));
  }
  for (std::size_t col = row.size() - 1; col-- > 0;) {
    row[col] += film.to_previous[col + 1] * film.part[col] * row[col + 1];
  }
}

void divide_column(const GroundedRowsFilm& film, std::vector<double>& column) noexcept {
  for (std::size_t col = 0; col < column.size(); ++col) {
    column[col] = film.part[col] * (column[col] + (col > 0 ? film.to_previous[col] * column[col - 1] : 0.0));
  }
  for (std::size_t col = column.size() - 1; col-- > 0;) {
    column[col] += film.to_next[col] * film.part[col] * column[col + 1];
  }
}

}  // namespace dermis::touch::compensation
