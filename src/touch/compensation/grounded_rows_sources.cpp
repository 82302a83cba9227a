// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// The voltages that amplifiers hold their columns at, in GroundedRows.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "dermis/touch/frames/processor_clones.hpp"
#include "touch/compensation/film_columns.hpp"
#include "touch/compensation/film_terms.hpp"
#include "touch/compensation/grounded_rows.hpp"

namespace dermis::touch::compensation {
namespace {

constexpr double kSourceShare = 1e-3;  // of the tolerance, to which the sources' column voltages are found
constexpr int kPlainPasses = 6;
constexpr int kSourcePasses = 60;
constexpr double kSourceWork = 0.2;  // of a pass beside a step without mixing

}  // namespace

/// Puts into y what the sources drive into the array at the present G, all rows grounded. Eliminating the rows as in
/// (b) leaves v = diag(w) (e + RL G^T diag(Rd / a) G v) for the columns, a contraction. Where that is a weak one,
/// Anderson's mixing speeds it up. Returns the change of v that is left where the work is used up; infinite where it
/// does not settle.
double GroundedRows::follow_sources() noexcept {
  int pass = 0;
  double change = std::numeric_limits<double>::infinity();
  sources_.mixing.forget();
  do {
    change = 0.0;
    find_row_currents();
    std::swap(sources_.last_ratio, sources_.column_ratio);
    find_column_ratios();
    for (std::size_t col = 0; col < state_.cols; ++col) {
      sources_.change[col] = sources_.column_ratio[col] - sources_.last_ratio[col];
      change = std::max(change, std::abs(sources_.change[col]));
    }
    if (pass >= kPlainPasses) {
      sources_.column_ratio = sources_.last_ratio;
      sources_.mixing.advance(sources_.column_ratio, sources_.change);
    }
  } while (change > kSourceShare * tolerance_ && ++pass < kSourcePasses && budget_.take(kSourceWork));
  find_row_currents();
  for (std::size_t col = 0; col < state_.cols; ++col) {
    const double current =
        sources_.column_ratio[col] * sources_.column_sum[col] - sources_.column_return[col] + current_into_film(col);
    for (std::size_t row = 0; row < state_.rows; ++row) {
      const std::size_t k = row * state_.stride + col;
      const bool held = state_.explained[k] > state_.measured[k];
      state_.measured[k] += current - sources_.siemens[col];
      state_.explained[k] = held ? std::max(state_.explained[k], state_.measured[k]) : state_.measured[k];
      state_.dropped[k] = state_.drive_ohm[row] * state_.explained[k];
    }
    sources_.siemens[col] = current;
  }
  if (change <= kSourceShare * tolerance_) return 0.0;
  return pass < kSourcePasses ? change : std::numeric_limits<double>::infinity();
}

/// G^T diag(Rd / a) G v and G^T 1.
DERMIS_PROCESSOR_CLONES void GroundedRows::find_row_currents() noexcept {
  std::fill(sources_.column_return.begin(), sources_.column_return.end(), 0.0);
  std::fill(sources_.column_sum.begin(), sources_.column_sum.end(), 0.0);
  for (std::size_t row = 0; row < state_.rows; ++row) {
    const double* const siemens = &state_.siemens[row * state_.stride];
    double current = 0.0;
    const double* const column_ratio = sources_.column_ratio.data();
#pragma omp simd reduction(+ : current)
    for (std::size_t col = 0; col < state_.cols; ++col) current += siemens[col] * column_ratio[col];
    sources_.line_ratio[row] = current;
  }
  if (state_.film) find_lines_with_film(state_, sources_.line_ratio);
  for (std::size_t row = 0; row < state_.rows; ++row) {
    const double* const siemens = &state_.siemens[row * state_.stride];
    double& line_ratio = sources_.line_ratio[row];
    if (!state_.film) line_ratio = line_ratio * state_.drive_ohm[row] / state_.line_gain[row];
    double* const column_return = sources_.column_return.data();
    double* const column_sum = sources_.column_sum.data();
    const double ratio = line_ratio;
#pragma omp simd
    for (std::size_t col = 0; col < state_.cols; ++col) {
      column_return[col] += siemens[col] * ratio;
      column_sum[col] += siemens[col];
    }
  }
}

void GroundedRows::find_column_ratios() noexcept {
  for (std::size_t col = 0; col < state_.cols; ++col) {
    sources_.column_ratio[col] = sources_.ratio[col] + state_.column_ohm[col] * sources_.column_return[col];
  }
  if (state_.film) return divide_column(*state_.film, sources_.column_ratio);
  for (std::size_t col = 0; col < state_.cols; ++col) sources_.column_ratio[col] *= state_.column_part[col];
}

/// From a column of these ratios to its neighbours.
double GroundedRows::current_into_film(std::size_t col) const noexcept {
  if (!state_.film) return 0.0;
  const std::vector<double>& between = state_.film->follower.film().between_cols;
  const auto flow = [&](std::size_t first, std::size_t from, std::size_t to) {
    return between[first] * (sources_.column_ratio[from] - sources_.column_ratio[to]);
  };
  return (col > 0 ? flow(col - 1, col, col - 1) : 0.0) + (col < between.size() ? flow(col, col, col + 1) : 0.0);
}

}  // namespace dermis::touch::compensation
