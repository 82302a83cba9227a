// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/film_terms.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "dermis/touch/frames/processor_clones.hpp"

namespace dermis::touch::compensation {
namespace {

constexpr double kLeastShare = 1e-6;  // of the supply that a column leaves

/// A film from a line to both neighbours; `between` [lines - 1].
double film_of_line(const std::vector<double>& between, std::size_t line) {
  return (line > 0 ? between[line - 1] : 0.0) + (line < between.size() ? between[line] : 0.0);
}

/// Adds a row to sums over rows. All of these loops work on whole rows of `count` values that do not overlap.
DERMIS_PROCESSOR_CLONES void add_row(const double* __restrict row, double* __restrict sums, std::size_t count) {
  for (std::size_t col = 0; col < count; ++col) sums[col] += row[col];
}

/// out += siemens in
DERMIS_PROCESSOR_CLONES void add_scaled(double siemens, const double* __restrict in, double* __restrict out,
                                        std::size_t count) {
  for (std::size_t col = 0; col < count; ++col) out[col] += siemens * in[col];
}

/// out += what flows in from the neighbours of each column: RL_j' l in_j' of both. `scale`: of out.
DERMIS_PROCESSOR_CLONES void flow_along_columns(const double* __restrict to_next, const double* __restrict to_previous,
                                                const double* __restrict in, const double* __restrict scale,
                                                double* __restrict out, std::size_t count) {
  out[0] += scale[0] * to_previous[1] * in[1];
  for (std::size_t col = 1; col + 1 < count; ++col) {
    out[col] += scale[col] * (to_next[col - 1] * in[col - 1] + to_previous[col + 1] * in[col + 1]);
  }
  out[count - 1] += scale[count - 1] * to_next[count - 2] * in[count - 2];
}

/// Z of a row, and its residual in the certificate.
DERMIS_PROCESSOR_CLONES void find_currents(double gain, double off_diagonal, const double* __restrict explained,
                                           const double* __restrict returned, const double* __restrict drawn,
                                           double* __restrict currents, double* __restrict worst,
                                           double* __restrict spread, std::size_t count) {
  for (std::size_t col = 0; col < count; ++col) {
    const double z = gain * explained[col] - returned[col];
    const double residual = std::abs(z - drawn[col]);
    currents[col] = z;
    worst[col] = residual > worst[col] ? residual : worst[col];
    spread[col] += residual * off_diagonal;
  }
}

/// G C^-1
DERMIS_PROCESSOR_CLONES void multiply_columns(const double* __restrict in, const double* __restrict factor,
                                              double* __restrict out, std::size_t count) {
  for (std::size_t col = 0; col < count; ++col) out[col] = in[col] * factor[col];
}

void sum_columns(const GroundedRowsState& state, const std::vector<double>& matrix, std::vector<double>& sums) {
  std::fill(sums.begin(), sums.end(), 0.0);
  for (std::size_t first = 0; first < matrix.size(); first += state.stride) {
    add_row(&matrix[first], sums.data(), state.stride);
  }
}

/// x of x P = G, by elimination from the first column on and back (Thomas).
DERMIS_PROCESSOR_CLONES void divide_by_columns(GroundedRowsState& state) {
  GroundedRowsFilm& film = *state.film;
  for (std::size_t col = 0; col < state.cols; ++col) {
    const double from_left = col > 0 ? film.to_next[col - 1] : 0.0;
    const double pivot = 1.0 / (1.0 / state.column_part[col] - (col > 0 ? from_left * film.upper[col - 1] : 0.0));
    film.upper[col] = col + 1 < state.cols ? film.to_previous[col + 1] * pivot : 0.0;
    for (std::size_t k = col; k < film.drawn.size(); k += state.stride) {
      film.drawn[k] = (state.siemens[k] + (col > 0 ? from_left * film.drawn[k - 1] : 0.0)) * pivot;
    }
  }
  for (std::size_t col = state.cols - 1; col-- > 0;) {
    for (std::size_t k = col; k < film.drawn.size(); k += state.stride)
      film.drawn[k] += film.upper[col] * film.drawn[k + 1];
  }
}

void flow_along_rows(GroundedRowsState& state) {
  const std::vector<double>& between = state.film->follower.film().between_rows;
  for (std::size_t row = 0; row < between.size(); ++row) {
    const std::size_t own = row * state.stride;
    const std::size_t next = own + state.stride;
    add_scaled(between[row], &state.dropped[next], &state.returned[own], state.stride);
    add_scaled(between[row], &state.dropped[own], &state.returned[next], state.stride);
  }
}

/// Z, and its certificate.
double find_currents(GroundedRowsState& state) {
  GroundedRowsFilm& film = *state.film;
  std::fill(film.worst.begin(), film.worst.end(), 0.0);
  std::fill(film.spread.begin(), film.spread.end(), 0.0);
  for (std::size_t row = 0; row < state.rows; ++row) {
    const std::size_t first = row * state.stride;
    find_currents(state.line_gain[row], 1.0 - state.line_part[row], &state.explained[first], &state.returned[first],
                  &film.drawn[first], &film.currents[first], film.worst.data(), film.spread.data(), state.stride);
  }
  double largest = 0.0;
  double total = 0.0;
  for (std::size_t col = 0; col < state.stride; ++col) {
    const double bound = (film.worst[col] + film.spread[col]) * state.certificate_ratio[col];
    largest = std::max(largest, bound);
    total += bound;  // shows what is not a number
  }
  return std::isfinite(total) ? largest : std::numeric_limits<double>::infinity();
}

void flow_along_columns(GroundedRowsState& state, const double* in, const double* scale, double* out) {
  const GroundedRowsFilm& film = *state.film;
  flow_along_columns(film.to_next.data(), film.to_previous.data(), in, scale, out, state.stride);
}

/// The sums of (c), without the taxels whose conductances are given.
void sum_currents(GroundedRowsState& state) {
  GroundedRowsFilm& film = *state.film;
  sum_columns(state, film.currents, film.sums);
  std::fill(film.flow.begin(), film.flow.end(), 0.0);
  flow_along_columns(state, film.sums.data(), film.ones.data(), film.flow.data());
  for (const auto& [row, col, siemens] : state.kept) {
    const double* const line = &film.currents[row * state.stride];
    film.sums[col] -= line[col];
    if (col > 0) film.flow[col] -= film.to_next[col - 1] * line[col - 1];
    if (col + 1 < state.cols) film.flow[col] -= film.to_previous[col + 1] * line[col + 1];
  }
}

/// (c)
void scale_columns(GroundedRowsState& state) {
  sum_currents(state);
  const GroundedRowsFilm& film = *state.film;
  for (std::size_t col = 0; col < state.cols; ++col) {
    const double ohm = state.column_ohm[col];
    const double own = 1.0 + film.to_next[col] + film.to_previous[col];
    const double entering = state.kept_siemens[col] + own * film.sums[col] - film.flow[col];
    const double siemens = std::max(entering, 0.0) / std::max(1.0 - ohm * film.sums[col], kLeastShare);
    state.column_scale[col] = own + ohm * siemens;
  }
}

/// f
void return_through_film(GroundedRowsState& state) {
  GroundedRowsFilm& film = *state.film;
  for (std::size_t col = 0; col < state.stride; ++col) film.sums[col] = 1.0 / state.column_scale[col];
  for (std::size_t first = 0; first < state.returned.size(); first += state.stride) {
    flow_along_columns(state, &film.currents[first], film.sums.data(), &state.returned[first]);
  }
}

}  // namespace

GroundedRowsFilm::GroundedRowsFilm(const FilmFollower& film_follower, std::size_t rows, std::size_t stride)
    : follower(film_follower), drawn(rows * stride), currents(rows * stride) {
  for (auto* values : {&upper, &to_next, &to_previous, &sums, &flow, &worst, &spread}) values->resize(stride);
  ones.assign(stride, 1.0);
}

void GroundedRowsFilm::update_flows(const GroundedRowsState& state) noexcept {
  const std::vector<double>& between = follower.film().between_cols;
  for (std::size_t col = 0; col < between.size(); ++col) {
    to_next[col] = state.column_ohm[col] * between[col];
    to_previous[col + 1] = state.column_ohm[col + 1] * between[col];
  }
}

void put_film_into_lines(GroundedRowsState& state) noexcept {
  GroundedRowsFilm& film = *state.film;
  film.follower.follow(state.siemens, state.stride);
  film.update_flows(state);
  for (std::size_t row = 0; row < state.rows; ++row) {
    state.line_gain[row] += state.drive_ohm[row] * film_of_line(film.follower.film().between_rows, row);
    state.line_part[row] = 1.0 / state.line_gain[row];
  }
  sum_columns(state, state.siemens, film.sums);
  for (std::size_t col = 0; col < state.cols; ++col) {
    const double ohm = state.column_ohm[col];
    state.column_part[col] = 1.0 / (1.0 + ohm * film.sums[col] + film.to_next[col] + film.to_previous[col]);
  }
  divide_by_columns(state);
  for (std::size_t first = 0; first < film.drawn.size(); first += state.stride) {
    multiply_columns(&film.drawn[first], state.column_ohm.data(), &state.shunted[first], state.stride);
  }
}

double assess_with_film(GroundedRowsState& state) noexcept {
  flow_along_rows(state);
  for (const auto& [row, col, siemens] : state.kept) {
    const std::size_t k = row * state.stride + col;
    state.measured[k] = (state.film->drawn[k] + state.returned[k]) / state.line_gain[row];
  }
  const double certificate = find_currents(state);
  scale_columns(state);
  return_through_film(state);
  return certificate;
}

void exchange_film_currents(GroundedRowsState& state) noexcept {
  GroundedRowsFilm& film = *state.film;
  film.update_flows(state);
  for (std::size_t col = 0; col < state.stride; ++col) {
    film.sums[col] = 1.0 + film.to_next[col] + film.to_previous[col];
    film.flow[col] = -1.0;
  }
  for (std::size_t first = 0; first < film.currents.size(); first += state.stride) {
    multiply_columns(&state.measured[first], film.sums.data(), &film.currents[first], state.stride);
    flow_along_columns(state, &state.measured[first], film.flow.data(), &film.currents[first]);
  }
  std::swap(state.measured, film.currents);
}

}  // namespace dermis::touch::compensation
