// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"
#include "support/dense_solve.hpp"

namespace dermis::support {

/// Readings over the supply [rows, cols] of every circuit, one scan after another by modified nodal analysis: unknown
/// are the voltages of all nodes and the currents of all drivers, loads and line segments, so that 0 ohm is nothing
/// special. Slow and plain, so that it shares nothing with what it judges. Floating lines need a taxel. A film is
/// spread evenly over the taxels.
class NodalReadout {
 public:
  explicit NodalReadout(const ArrayDescription& array) : NodalReadout(array, film_of(array)) {}
  NodalReadout(const ArrayDescription& array, const FilmConductances& film) : array_(array), film_(film) {}

  [[nodiscard]] std::vector<double> ratios(const std::vector<double>& siemens) const {
    std::vector<double> ratio(array_.taxel_count());
    for (std::size_t row = 0; row < array_.rows; ++row) {
      for (std::size_t col = 0; col < array_.cols; ++col) ratio[array_.index(row, col)] = reading(siemens, row, col);
    }
    return ratio;
  }

 private:
  [[nodiscard]] static FilmConductances film_of(const ArrayDescription& array) {
    FilmConductances film(array.rows, array.cols);
    if (array.readout.film) film.set(*array.readout.film, std::vector<double>(array.taxel_count()));
    return film;
  }

  struct Equations {
    explicit Equations(std::size_t unknowns) : size(unknowns), matrix(size * size, 0.0), right(size, 0.0) {}
    double& operator()(std::size_t row, std::size_t col) { return matrix[row * size + col]; }
    std::size_t size;
    std::vector<double> matrix;
    std::vector<double> right;
  };

  [[nodiscard]] std::size_t row_node(std::size_t row, std::size_t col) const { return array_.index(row, col); }
  [[nodiscard]] std::size_t column_node(std::size_t row, std::size_t col) const {
    return array_.taxel_count() + array_.index(row, col);
  }

  [[nodiscard]] double reading(const std::vector<double>& siemens, std::size_t row, std::size_t col) const {
    const Readout& readout = array_.readout;
    const std::size_t rows = array_.rows;
    const std::size_t cols = array_.cols;
    const bool flexitac = readout.circuit == Circuit::flexitac;
    const std::size_t nodes = 2 * array_.taxel_count();
    const std::size_t segments = rows * (cols - 1) + cols * (rows - 1);
    Equations equations(nodes + segments + rows + cols);
    const auto conduct = [&](std::size_t a, std::size_t b, double g) {
      equations(a, a) += g;
      equations(b, b) += g;
      equations(a, b) -= g;
      equations(b, a) -= g;
    };
    for (std::size_t i = 0; i < rows; ++i) {
      for (std::size_t j = 0; j < cols; ++j) {
        conduct(row_node(i, j), column_node(i, j), siemens[array_.index(i, j)]);
        const double of_rows = i > 0 ? film_.between_rows[i - 1] / static_cast<double>(cols) : 0.0;
        const double of_cols = j > 0 ? film_.between_cols[j - 1] / static_cast<double>(rows) : 0.0;
        if (i > 0) conduct(row_node(i - 1, j), row_node(i, j), of_rows);
        if (j > 0) conduct(column_node(i, j - 1), column_node(i, j), of_cols);
      }
    }
    std::size_t branch = nodes;
    const auto join = [&](std::size_t a, std::size_t b, double ohm) {
      equations(a, branch) += 1.0;
      equations(b, branch) -= 1.0;
      equations(branch, a) = 1.0;
      equations(branch, b) = -1.0;
      equations(branch, branch) = -ohm;
      ++branch;
    };
    const auto ohm_of = [](const std::vector<double>& ohms, std::size_t line) {
      return ohms.empty() ? 0.0 : ohms[line];
    };
    for (std::size_t i = 0; i < rows; ++i) {
      for (std::size_t j = 0; j + 1 < cols; ++j) {
        join(row_node(i, j), row_node(i, j + 1), ohm_of(readout.row_segment_ohm, i));
      }
    }
    for (std::size_t j = 0; j < cols; ++j) {
      for (std::size_t i = 0; i + 1 < rows; ++i) {
        join(column_node(i, j), column_node(i + 1, j), ohm_of(readout.column_segment_ohm, j));
      }
    }
    // Current into the head of a line through `ohm` from a source of `volt`, or none.
    const auto tie = [&](std::size_t node, bool tied, double ohm, double volt) {
      equations(node, branch) -= 1.0;
      if (tied) {
        equations(branch, node) = 1.0;
        equations(branch, branch) = ohm;
        equations.right[branch] = volt;
      } else {
        equations(branch, branch) = 1.0;
      }
      ++branch;
    };
    const double inverse_gain = readout.amplifier_gain ? 1.0 / *readout.amplifier_gain : 0.0;
    for (std::size_t i = 0; i < rows; ++i) {
      if (flexitac) {
        tie(row_node(i, 0), i == row, readout.load_ohm[i], 0.0);
      } else {
        tie(row_node(i, 0), i == row || readout.idle_rows == IdleRows::grounded, readout.drive_ohm[i],
            i == row ? 1.0 : 0.0);
      }
    }
    const std::size_t column_branches = branch;
    const auto off = [&](std::size_t j) {
      return readout.amplifier_offset_v.empty() ? 0.0 : readout.amplifier_offset_v[j] / *readout.supply_v;
    };
    for (std::size_t j = 0; j < cols; ++j) {
      if (flexitac) {
        tie(column_node(0, j), true, readout.drive_ohm[j], j == col ? 1.0 : 0.0);
      } else if (readout.circuit == Circuit::transimpedance) {
        // The input stands at e = off + r / A0 with r = I RL - e, I = the current out of the column: e (1 + 1/A0) =
        // off + I RL / A0.
        const double scale = 1.0 / (1.0 + inverse_gain);
        tie(column_node(0, j), true, ohm_of(readout.column_switch_ohm, j) + readout.load_ohm[j] * inverse_gain * scale,
            off(j) * scale);
      } else {
        tie(column_node(0, j), j == col || readout.idle_columns == IdleColumns::loaded, readout.load_ohm[j], 0.0);
      }
    }
    const std::vector<double> solution = solve(std::move(equations.matrix), std::move(equations.right), equations.size);
    if (flexitac) return solution[row_node(row, 0)];
    if (readout.circuit == Circuit::divider) return solution[column_node(0, col)];
    const double out = -solution[column_branches + col];
    return (out * readout.load_ohm[col] - off(col)) / (1.0 + inverse_gain);
  }

  ArrayDescription array_;
  FilmConductances film_;
};

}  // namespace dermis::support
