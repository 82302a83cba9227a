// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cassert>
#include <cstddef>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"
#include "support/dense_solve.hpp"

namespace dermis::support {

/// Readings over the supply of a divider whose idle rows are grounded, [rows, cols], from the whole nodal system of row
/// and column lines: written anew for the tests, without a Schur complement and without dermis' simulator.
inline std::vector<double> divider_ratios(const ArrayDescription& array, const std::vector<double>& siemens) {
  const Readout& readout = array.readout;
  assert(readout.circuit == Circuit::divider && readout.idle_rows == IdleRows::grounded);
  const std::size_t rows = array.rows;
  const std::size_t lines = rows + array.cols;
  std::vector<double> matrix(lines * lines, 0.0);
  std::vector<double> right(lines * rows, 0.0);  // one column for each driven row
  for (std::size_t i = 0; i < rows; ++i) {
    // Kirchhoff's current law at the row, times drive_ohm: a driver of 0 ohm then fixes the voltage of its line.
    matrix[i * lines + i] = 1.0;
    right[i * rows + i] = 1.0;
    for (std::size_t j = 0; j < array.cols; ++j) {
      const double g = siemens[array.index(i, j)];
      const std::size_t column = rows + j;
      matrix[i * lines + i] += readout.drive_ohm[i] * g;
      matrix[i * lines + column] -= readout.drive_ohm[i] * g;
      matrix[column * lines + column] += g;
      matrix[column * lines + i] -= g;
    }
  }
  for (std::size_t j = 0; j < array.cols; ++j) matrix[(rows + j) * lines + rows + j] += 1.0 / readout.load_ohm[j];
  const std::vector<double> voltages = solve(std::move(matrix), std::move(right), lines);
  std::vector<double> ratio(rows * array.cols);
  for (std::size_t driven = 0; driven < rows; ++driven) {
    for (std::size_t j = 0; j < array.cols; ++j) ratio[array.index(driven, j)] = voltages[(rows + j) * rows + driven];
  }
  return ratio;
}

/// The same for columns at virtual ground: the current into column j times load_ohm_j, over the supply.
inline std::vector<double> transimpedance_ratios(const ArrayDescription& array, const std::vector<double>& siemens) {
  std::vector<double> ratio(siemens.size());
  for (std::size_t i = 0; i < array.rows; ++i) {
    double row_siemens = 0.0;
    for (std::size_t j = 0; j < array.cols; ++j) row_siemens += siemens[array.index(i, j)];
    const double row_voltage = 1.0 / (1.0 + array.readout.drive_ohm[i] * row_siemens);
    for (std::size_t j = 0; j < array.cols; ++j) {
      ratio[array.index(i, j)] = row_voltage * siemens[array.index(i, j)] * array.readout.load_ohm[j];
    }
  }
  return ratio;
}

}  // namespace dermis::support
