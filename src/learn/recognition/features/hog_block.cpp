// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/recognition/features/hog_block.hpp"

#include <algorithm>
#include <cmath>

namespace dermis::learn::recognition {
namespace {

std::vector<CellShares> cell_shares(std::size_t lines, std::size_t cells) {
  const double length = static_cast<double>(lines) / static_cast<double>(cells);
  std::vector<CellShares> shares;
  for (std::size_t line = 0; line < lines; ++line) {
    const std::size_t cell = line * cells / lines;
    const double rest = std::max(static_cast<double>(line + 1) - length * static_cast<double>(cell + 1), 0.0);
    const bool has_next = cell + 1 < cells;
    shares.push_back({cell, (1.0 - rest) / length, has_next ? rest / length : 0.0});
  }
  return shares;
}

}  // namespace

HogBlock::HogBlock(const Lattice& lattice, std::size_t row_cells, std::size_t col_cells)
    : row_shares_(cell_shares(lattice.rows, row_cells)),
      col_shares_(cell_shares(lattice.cols, col_cells)),
      of_row_(col_cells * kOrientations) {}

void HogBlock::write(const ImageAnalysis& analysis, std::span<double> out) {
  const std::size_t cols = col_shares_.size();
  std::fill(out.begin(), out.end(), 0.0);
  for (std::size_t row = 0; row < row_shares_.size(); ++row) {
    std::fill(of_row_.begin(), of_row_.end(), 0.0);
    for (std::size_t col = 0; col < cols; ++col) {
      const double place = analysis.direction()[row * cols + col] * static_cast<double>(kOrientations);
      const auto below = static_cast<std::size_t>(place);
      const double size = analysis.steepness()[row * cols + col];
      const double upper = size * (place - static_cast<double>(below));
      const std::size_t bins[] = {below % kOrientations, (below + 1) % kOrientations};
      const auto [cell, of_cell, of_next] = col_shares_[col];
      double* const sums = of_row_.data() + cell * kOrientations;
      sums[bins[0]] += of_cell * (size - upper);
      sums[bins[1]] += of_cell * upper;
      if (of_next == 0.0) continue;
      sums[kOrientations + bins[0]] += of_next * (size - upper);
      sums[kOrientations + bins[1]] += of_next * upper;
    }
    const auto [cell, of_cell, of_next] = row_shares_[row];
    double* const sums = out.data() + cell * of_row_.size();
    for (std::size_t i = 0; i < of_row_.size(); ++i) sums[i] += of_cell * of_row_[i];
    if (of_next == 0.0) continue;
    for (std::size_t i = 0; i < of_row_.size(); ++i) sums[of_row_.size() + i] += of_next * of_row_[i];
  }
  for (double& value : out) value = std::sqrt(value);
}

}  // namespace dermis::learn::recognition
