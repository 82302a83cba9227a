// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/film_terms.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "dermis/touch/frames/processor_clones.hpp"
#include "touch/compensation/film_columns.hpp"
#include "touch/compensation/matrix_product.hpp"

namespace dermis::touch::compensation {
namespace {

constexpr double kLeastLineRatio = 0.05;  // of the supply that a row leaves, for the estimate
constexpr double kMostStretch = 1.0;      // of a step by the last one

/// A film from a line to both neighbours; `between` [lines - 1].
double film_of_line(const std::vector<double>& between, std::size_t line) {
  return (line > 0 ? between[line - 1] : 0.0) + (line < between.size() ? between[line] : 0.0);
}

void clear(std::vector<double>& values) {
  std::fill(values.begin(), values.end(), 0.0);
}

/// G^T 1
DERMIS_PROCESSOR_CLONES void sum_columns(const GroundedRowsState& state, std::vector<double>& sums) {
  const std::size_t stride = state.stride;
  double* const sum = sums.data();
  clear(sums);
  for (std::size_t row = 0; row < state.rows; ++row) {
    const double* const siemens = &state.siemens[row * stride];
#pragma omp simd
    for (std::size_t col = 0; col < stride; ++col) sum[col] += siemens[col];
  }
}

/// Sums over the rows of Z, and with one load of its positive parts and of these times `dropped`.
DERMIS_PROCESSOR_CLONES void sum_currents(const GroundedRowsState& state) {
  GroundedRowsFilm& film = *state.film;
  const std::size_t stride = state.stride;
  double* const sum = film.sums.data();
  double* const weight = film.weights.data();
  double* const drop = film.drops.data();
  for (std::vector<double>* const values : {&film.sums, &film.weights, &film.drops}) clear(*values);
  for (std::size_t row = 0; row < state.rows; ++row) {
    const double* const current = &film.currents[row * stride + 1];
    const double* const dropped = &state.dropped[row * stride];
#pragma omp simd
    for (std::size_t col = 0; col < stride; ++col) sum[col] += current[col];
    if (!film.one_loaded) continue;
#pragma omp simd
    for (std::size_t col = 0; col < stride; ++col) {
      const double positive = current[col] > 0.0 ? current[col] : 0.0;
      weight[col] += positive;
      drop[col] += positive * dropped[col];
    }
  }
}

/// Z, and in `returned` all of (b) but the first term.
DERMIS_PROCESSOR_CLONES void find_currents(GroundedRowsState& state) {
  GroundedRowsFilm& film = *state.film;
  const std::size_t stride = state.stride;
  const std::vector<double>& between = film.follower.film().between_rows;
  for (std::size_t row = 0; row < state.rows; ++row) {
    const std::size_t first = row * stride;
    const double up = row > 0 ? between[row - 1] : 0.0;
    const double down = row + 1 < state.rows ? between[row] : 0.0;
    const double gain = state.line_gain[row];
    const double* const above = &state.dropped[row > 0 ? first - stride : first];
    const double* const below = &state.dropped[row + 1 < state.rows ? first + stride : first];
    const double* const explained = &state.explained[first];
    double* const returned = &state.returned[first];
    double* const current = &film.currents[first + 1];
#pragma omp simd
    for (std::size_t col = 0; col < stride; ++col) {
      returned[col] += up * above[col] + down * below[col];
      current[col] = gain * explained[col] - returned[col];
    }
  }
}

/// f in `returned`, and |E| over the rows.
DERMIS_PROCESSOR_CLONES void return_through_film(GroundedRowsState& state) {
  GroundedRowsFilm& film = *state.film;
  const std::size_t stride = state.stride;
  double* const worst = film.worst.data();
  double* const spread = film.spread.data();
  const double* const own = film.own.data();
  const double* const from_left = film.from_left.data();
  const double* const from_right = film.from_right.data();
  const double* const scale = film.work.data();
  clear(film.worst);
  clear(film.spread);
  for (std::size_t row = 0; row < state.rows; ++row) {
    const std::size_t first = row * stride;
    const double share = film.one_loaded ? 1.0 : 1.0 - state.line_part[row];
    const double* const current = &film.currents[first + 1];
    const double* const siemens = &state.siemens[first];
    double* const returned = &state.returned[first];
#pragma omp simd
    for (std::size_t col = 0; col < stride; ++col) {
      const double flow = from_left[col] * current[col - 1] + from_right[col] * current[col + 1];
      const double error = std::abs(own[col] * current[col] - flow - siemens[col]);
      worst[col] = error > worst[col] ? error : worst[col];
      spread[col] += share * error;
      returned[col] += scale[col] * flow;
    }
  }
}

/// Currents into a column from its neighbours in a row.
double flow_into(const GroundedRowsFilm& film, std::size_t col, const double* current) {
  const double from_left = col > 0 ? film.to_next[col - 1] * film.unit[col - 1] * current[-1] : 0.0;
  const bool has_next = col + 1 < film.unit.size();
  return from_left + (has_next ? film.to_previous[col + 1] * film.unit[col + 1] * current[1] : 0.0);
}

/// The readings of taxels without one: what they draw beside the others of their row.
void draw_kept(GroundedRowsState& state) {
  GroundedRowsFilm& film = *state.film;
  clear(film.kept_shares);
  clear(film.kept_sums);
  film.kept_changes.clear();
  for (const auto& [row, col, siemens] : state.kept) {
    const std::size_t k = row * state.stride + col;
    double& current = film.currents[k + 1];
    const double entering = siemens + std::max(flow_into(film, col, &current), 0.0);
    const double drawn = entering / (film.diagonal[col] * film.unit[col]);
    film.kept_changes.push_back(std::abs(drawn - current));
    film.kept_shares[col] += drawn * film.unit[col];
    film.kept_sums[col] += drawn;
    current = drawn;
    state.measured[k] = (drawn + state.returned[k]) / state.line_gain[row];
  }
}

/// What kept taxels draw is not yet what they were counted with.
void doubt_kept(const GroundedRowsState& state) {
  GroundedRowsFilm& film = *state.film;
  for (std::size_t k = 0; k < state.kept.size(); ++k) {
    const std::size_t col = state.kept[k].col;
    const double change = film.kept_changes[k];
    film.spread[col] += film.own[col] * change;
    if (col > 0) film.spread[col - 1] += film.from_right[col - 1] * change;
    if (col + 1 < state.cols) film.spread[col + 1] += film.from_left[col + 1] * change;
  }
}

double certificate_of(const GroundedRowsState& state) {
  GroundedRowsFilm& film = *state.film;
  for (std::size_t col = 0; col < state.stride; ++col) {
    film.work[col] = film.one_loaded ? 2.0 * film.spread[col] : film.worst[col] + film.spread[col];
  }
  divide_row(film, film.work);
  double largest = 0.0;
  double total = 0.0;
  for (std::size_t col = 0; col < state.cols; ++col) {
    const double bound = (film.work[col] + film.doubt[col]) / film.unit[col] * state.certificate_ratio[col];
    largest = std::max(largest, bound);
    total += bound;  // shows what is not a number
  }
  return std::isfinite(total) ? largest : std::numeric_limits<double>::infinity();
}

/// The readings as currents of rows that take nothing from each other.
DERMIS_PROCESSOR_CLONES void load_readings(GroundedRowsState& state) {
  GroundedRowsFilm& film = *state.film;
  std::copy(state.measured.begin(), state.measured.end(), film.currents.begin() + 1);
  for (std::size_t row = 0; row < state.rows; ++row) {
    const double ohm = state.drive_ohm[row];
    const double* const measured = &state.measured[row * state.stride];
    double* const dropped = &state.dropped[row * state.stride];
#pragma omp simd
    for (std::size_t col = 0; col < state.stride; ++col) dropped[col] = ohm * measured[col];
  }
  sum_currents(state);
  clear(film.kept_sums);
}

/// As textbooks have it: each row by itself.
DERMIS_PROCESSOR_CLONES void estimate_rows(GroundedRowsState& state) {
  const GroundedRowsFilm& film = *state.film;
  const double* const own = film.own.data();
  const double* const from_left = film.from_left.data();
  const double* const from_right = film.from_right.data();
  for (std::size_t row = 0; row < state.rows; ++row) {
    const double* const current = &film.currents[row * state.stride + 1];
    double* const line = &state.estimate[row * state.stride];
    double sum = 0.0;
#pragma omp simd reduction(+ : sum)
    for (std::size_t col = 0; col < state.stride; ++col) {
      const double flow = from_left[col] * current[col - 1] + from_right[col] * current[col + 1];
      const double siemens = own[col] * current[col] - flow;
      line[col] = siemens > 0.0 ? siemens : 0.0;
      sum += line[col];
    }
    const double gain = 1.0 / std::max(1.0 - state.drive_ohm[row] * sum, kLeastLineRatio);
#pragma omp simd
    for (std::size_t col = 0; col < state.stride; ++col) line[col] *= gain;
  }
}

/// How much of the last step makes this one smallest, were they linear.
DERMIS_PROCESSOR_CLONES double share_of_last_step(const std::vector<double>& next, const std::vector<double>& from,
                                                  const std::vector<double>& last) {
  const double* const to = next.data();
  const double* const start = from.data();
  const double* const before = last.data();
  double along = 0.0;
  double square = 0.0;
#pragma omp simd reduction(+ : along, square)
  for (std::size_t k = 0; k < next.size(); ++k) {
    const double step = to[k] - start[k];
    const double turn = step - before[k];
    along += step * turn;
    square += turn * turn;
  }
  return square > 0.0 ? std::clamp(along / square, -kMostStretch, kMostStretch) : 0.0;
}

/// Changes G along the change of its last step, and keeps both.
DERMIS_PROCESSOR_CLONES void add_to_step(double share, const std::vector<double>& from, GroundedRowsState& state) {
  GroundedRowsFilm& film = *state.film;
  double* const siemens = state.siemens.data();
  double* const last = film.last_siemens.data();
  double* const step = film.last_step.data();
  const double* const start = from.data();
#pragma omp simd
  for (std::size_t k = 0; k < state.siemens.size(); ++k) {
    const double next = siemens[k];
    const double moved = next - share * (next - last[k]);
    step[k] = next - start[k];
    last[k] = next;
    siemens[k] = next > 0.0 && moved > 0.0 ? moved : 0.0;
  }
}

}  // namespace

GroundedRowsFilm::GroundedRowsFilm(const FilmFollower& film_follower, const GroundedRowsState& state)
    : follower(film_follower),
      one_loaded(state.idle_columns == IdleColumns::floating),
      scale(one_loaded ? std::vector<double>(state.stride, 1.0) : state.column_ohm),
      currents(state.rows * state.stride + 2),
      last_siemens(state.rows * state.stride),
      last_step(state.rows * state.stride),
      unit(state.stride, 1.0),
      line_part(state.rows) {
  kept_changes.reserve(state.rows * state.cols);
  for (auto* values : {&to_next, &to_previous, &column_sum, &diagonal, &part, &inverse, &sums, &weights, &drops,
                       &kept_shares, &kept_sums, &own, &from_left, &from_right, &doubt, &worst, &spread, &work}) {
    values->resize(state.stride);
  }
}

void put_film_into_lines(GroundedRowsState& state) noexcept {
  GroundedRowsFilm& film = *state.film;
  film.follower.follow(state.siemens, state.stride, film.precision);
  follow_film(film);
  for (std::size_t row = 0; row < state.rows; ++row) {
    state.line_gain[row] += state.drive_ohm[row] * film_of_line(film.follower.film().between_rows, row);
    state.line_part[row] = 1.0 / state.line_gain[row];
  }
  sum_columns(state, film.column_sum);
  factorise_columns(film);
}

double assess_with_film(GroundedRowsState& state) noexcept {
  GroundedRowsFilm& film = *state.film;
  find_currents(state);
  draw_kept(state);
  sum_currents(state);
  find_columns(state, state.column_scale);
  weigh_columns(film);
  for (std::size_t col = 0; col < state.cols; ++col) {
    state.column_scale[col] *= film.unit[col];
    film.work[col] = 1.0 / state.column_scale[col];
  }
  return_through_film(state);
  doubt_kept(state);
  return certificate_of(state);
}

void estimate_with_film(GroundedRowsState& state) noexcept {
  GroundedRowsFilm& film = *state.film;
  follow_film(film);
  load_readings(state);
  estimate_columns(state);
  weigh_columns(film);
  state.column_scale = film.own;
  estimate_rows(state);
}

void hasten_with_film(GroundedRowsState& state, const std::vector<double>& from) noexcept {
  GroundedRowsFilm& film = *state.film;
  const double share = film.has_last_step ? share_of_last_step(state.siemens, from, film.last_step) : 0.0;
  add_to_step(share, from, state);
  film.has_last_step = true;
}

void shunt_with_film(GroundedRowsState& state) noexcept {
  GroundedRowsFilm& film = *state.film;
  clear(state.coupling);
  for (std::size_t col = 0; col < state.cols; ++col) state.coupling[col * state.stride + col] = 1.0;
  divide_by_columns(state, state.coupling);
  multiply(StridedMatrix<double>{state.siemens.data(), state.stride, 1}, state.coupling.data(), state.rows, state.cols,
           state.stride, state.shunted.data());
  for (std::size_t col = 0; col < state.cols; ++col) {
    state.column_part[col] = 1.0 / (film.unit[col] * film.diagonal[col]);
  }
}

void find_lines_with_film(GroundedRowsState& state, std::vector<double>& currents) noexcept {
  GroundedRowsFilm& film = *state.film;
  const std::vector<double>& between = film.follower.film().between_rows;
  for (std::size_t row = 0; row < state.rows; ++row) {
    const double ohm = state.drive_ohm[row];
    const double up = row > 0 ? ohm * between[row - 1] : 0.0;
    const double pivot = state.line_gain[row] - (row > 0 ? up * film.line_part[row - 1] : 0.0);
    currents[row] = (ohm * currents[row] + (row > 0 ? up * currents[row - 1] : 0.0)) / pivot;
    film.line_part[row] = row + 1 < state.rows ? ohm * between[row] / pivot : 0.0;
  }
  for (std::size_t row = state.rows - 1; row-- > 0;) currents[row] += film.line_part[row] * currents[row + 1];
}

}  // namespace dermis::touch::compensation
