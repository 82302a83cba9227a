// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "recognition/features/hog_block.hpp"

#include <algorithm>
#include <cmath>

namespace dermis::recognition {
namespace {

/// [lines, cells]: the part of each cell that each line covers.
std::vector<double> cell_shares(std::size_t lines, std::size_t cells) {
  const double length = static_cast<double>(lines) / static_cast<double>(cells);
  std::vector<double> shares(lines * cells);
  for (std::size_t line = 0; line < lines; ++line) {
    for (std::size_t cell = 0; cell < cells; ++cell) {
      const double begin = std::max(static_cast<double>(line), length * static_cast<double>(cell));
      const double end = std::min(static_cast<double>(line + 1), length * static_cast<double>(cell + 1));
      shares[line * cells + cell] = std::max(end - begin, 0.0) / length;
    }
  }
  return shares;
}

}  // namespace

HogBlock::HogBlock(const Lattice& lattice, std::size_t row_cells, std::size_t col_cells)
    : row_cells_(row_cells),
      col_cells_(col_cells),
      row_shares_(cell_shares(lattice.rows, row_cells)),
      col_shares_(cell_shares(lattice.cols, col_cells)),
      of_row_(col_cells * kOrientations) {}

void HogBlock::write(const ImageAnalysis& analysis, std::span<double> out) {
  const auto [rows, cols, row_step, col_step] = analysis.lattice();
  std::fill(out.begin(), out.end(), 0.0);
  for (std::size_t row = 0; row < rows; ++row) {
    std::fill(of_row_.begin(), of_row_.end(), 0.0);
    for (std::size_t col = 0; col < cols; ++col) {
      const double place = analysis.direction()[row * cols + col] * static_cast<double>(kOrientations);
      const double below = std::floor(place);
      const std::size_t bin = static_cast<std::size_t>(below) % kOrientations;
      const double size = analysis.steepness()[row * cols + col];
      const double upper = size * (place - below);
      for (std::size_t cell = 0; cell < col_cells_; ++cell) {
        const double share = col_shares_[col * col_cells_ + cell];
        if (share == 0.0) continue;
        of_row_[cell * kOrientations + bin] += share * (size - upper);
        of_row_[cell * kOrientations + (bin + 1) % kOrientations] += share * upper;
      }
    }
    for (std::size_t cell = 0; cell < row_cells_; ++cell) {
      const double share = row_shares_[row * row_cells_ + cell];
      if (share == 0.0) continue;
      double* const sums = out.data() + cell * of_row_.size();
      for (std::size_t i = 0; i < of_row_.size(); ++i) sums[i] += share * of_row_[i];
    }
  }
  for (double& value : out) value = std::sqrt(value);
}

}  // namespace dermis::recognition
