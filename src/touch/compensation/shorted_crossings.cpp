// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/shorted_crossings.hpp"

#include <algorithm>

namespace dermis::touch::compensation {
namespace {

using Crossing = GroundedRowsState::ShortedCrossing;

constexpr double kLeastLeft = 1e-3;  // of the supply, beside what a driver or a node takes

/// Rd_k y_kJ, above 0.
double node_drop(const GroundedRowsState& state, const std::vector<double>& currents, const Crossing& crossing) {
  const double current = currents[crossing.row * state.stride + crossing.col];
  const double full = state.drive_ohm[crossing.row] / state.column_ohm[crossing.col];
  return std::max(state.drive_ohm[crossing.row] * current, kLeastLeft * full);
}

const Crossing* crossing_of_row(const GroundedRowsState& state, std::size_t row) {
  for (const Crossing& crossing : state.shorted) {
    if (crossing.row == row && !crossing.is_second) return &crossing;
  }
  return nullptr;
}

/// Two nodes have two taxels between them and one equation: the taxel in the column of the later one is taken as 0 S.
bool stands_elsewhere(const GroundedRowsState& state, std::size_t row, const Crossing& crossing) {
  if (crossing.is_second) return true;
  const Crossing* const other = crossing_of_row(state, row);
  return other != nullptr && other < &crossing;
}

/// G_kJ of the present or the estimated conductances.
double node_siemens(const GroundedRowsState& state, const std::vector<double>& siemens, const Crossing& crossing) {
  double sum = state.idle_columns == IdleColumns::floating ? 0.0 : 1.0 / state.column_ohm[crossing.col];
  for (std::size_t row = 0; row < state.rows; ++row) {
    if (row != crossing.row) sum += siemens[row * state.stride + crossing.col];
  }
  return sum;
}

}  // namespace

void take_loads_away(GroundedRowsState& state) noexcept {
  if (state.idle_columns != IdleColumns::floating) return;
  for (const Crossing& crossing : state.shorted) {
    const double taken = state.drive_ohm[crossing.row] * state.measured[crossing.row * state.stride + crossing.col];
    const double left = std::max(1.0 - taken, kLeastLeft);
    for (std::size_t k = crossing.col; k < state.measured.size(); k += state.stride) state.measured[k] /= left;
  }
}

void estimate_with_shorted(GroundedRowsState& state) noexcept {
  for (const Crossing& crossing : state.shorted) {
    state.column_scale[crossing.col] = 1.0 / node_drop(state, state.measured, crossing);
  }
  for (std::size_t row = 0; row < state.rows; ++row) {
    double* const line = &state.estimate[row * state.stride];
    double sum = 0.0;
    for (std::size_t col = 0; col < state.stride; ++col) {
      line[col] = std::max(state.measured[row * state.stride + col], 0.0) * state.column_scale[col];
    }
    for (const Crossing& crossing : state.shorted) {
      if (crossing.row == row || stands_elsewhere(state, row, crossing)) line[crossing.col] = 0.0;
    }
    for (std::size_t col = 0; col < state.stride; ++col) sum += line[col];
    const Crossing* const own = crossing_of_row(state, row);
    const double left = own != nullptr ? state.column_ohm[own->col] * state.measured[row * state.stride + own->col]
                                       : 1.0 - state.drive_ohm[row] * sum;
    for (std::size_t col = 0; col < state.stride; ++col) line[col] /= std::clamp(left, 0.05, 1.0);
  }
  for (const Crossing& crossing : state.shorted) {
    state.estimate[crossing.row * state.stride + crossing.col] = node_siemens(state, state.estimate, crossing);
  }
}

void add_up_nodes(GroundedRowsState& state) noexcept {
  for (const Crossing& crossing : state.shorted) {
    for (std::size_t row = 0; row < state.rows; ++row) {
      if (stands_elsewhere(state, row, crossing)) state.siemens[row * state.stride + crossing.col] = 0.0;
    }
    state.siemens[crossing.row * state.stride + crossing.col] = node_siemens(state, state.siemens, crossing);
  }
}

void take_columns_away(GroundedRowsState& state) noexcept {
  for (const Crossing& crossing : state.shorted) {
    for (std::size_t k = crossing.col; k < state.shunted.size(); k += state.stride) state.shunted[k] = 0.0;
    state.column_part[crossing.col] = node_drop(state, state.explained, crossing);
  }
}

void return_through_nodes(GroundedRowsState& state) noexcept {
  const std::size_t stride = state.stride;
  for (const Crossing& crossing : state.shorted) {
    const std::size_t node = crossing.row * stride;
    for (std::size_t row = 0; row < state.rows; ++row) {
      const double siemens = state.siemens[row * stride + crossing.col];
      if (row == crossing.row || siemens == 0.0) continue;
      double* const returned = &state.returned[row * stride];
      const double own = returned[crossing.col];  // the unknown of its equation
      for (std::size_t col = 0; col < state.cols; ++col) {
        returned[col] += siemens * state.dropped[node + col];
        state.returned[node + col] += siemens * state.dropped[row * stride + col];
      }
      returned[crossing.col] = own;
    }
  }
  for (const Crossing& crossing : state.shorted) {
    for (std::size_t row = 0; row < state.rows; ++row) {
      if (row != crossing.row && !stands_elsewhere(state, row, crossing)) continue;
      const std::size_t k = row * stride + crossing.col;
      const double drawn = state.siemens[k] * state.column_part[crossing.col];
      state.returned[k] = state.line_gain[row] * state.explained[k] - drawn;
    }
  }
}

void scale_shorted_columns(GroundedRowsState& state) noexcept {
  for (const Crossing& crossing : state.shorted) {
    state.column_scale[crossing.col] = 1.0 / state.column_part[crossing.col];
  }
}

}  // namespace dermis::touch::compensation
