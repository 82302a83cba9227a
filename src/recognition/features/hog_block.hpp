// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "recognition/features/image_analysis.hpp"

namespace dermis::recognition {

/// Where edges are and how they run: histograms of oriented gradients over a grid of cells, which share a taxel that
/// lies in several by its area. Not thread-safe.
class HogBlock {
 public:
  static constexpr std::size_t kOrientations = 8;

  HogBlock(const Lattice& lattice, std::size_t row_cells, std::size_t col_cells);

  [[nodiscard]] std::size_t size() const noexcept { return kOrientations * row_cells_ * col_cells_; }
  /// `out`: [row cells, column cells, orientations]
  void write(const ImageAnalysis& analysis, std::span<double> out);

 private:
  std::size_t row_cells_;
  std::size_t col_cells_;
  std::vector<double> row_shares_;  ///< [rows, row cells]: how much of a cell a row makes up.
  std::vector<double> col_shares_;
  std::vector<double> of_row_;  ///< [column cells, orientations]
};

}  // namespace dermis::recognition
