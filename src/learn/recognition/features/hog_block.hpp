// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "learn/recognition/features/feature_group.hpp"
#include "learn/recognition/features/image_analysis.hpp"

namespace dermis::learn::recognition {

/// The shares of a line of taxels in a cell and in the next one, where its rest may lie. A cell has two lines or more.
struct CellShares {
  std::size_t cell = 0;
  double of_cell = 0.0;
  double of_next = 0.0;
};

/// Where edges are and how they run: histograms of oriented gradients over a grid of cells. Cells share a taxel that
/// lies in several by its area. Not thread-safe.
class HogBlock {
 public:
  HogBlock(const Lattice& lattice, std::size_t row_cells, std::size_t col_cells);

  [[nodiscard]] static FeatureGroup group(std::size_t row_cells, std::size_t col_cells) noexcept {
    return {"edges in cells", FeatureAspect::place, kOrientations * row_cells * col_cells};
  }
  /// `out`: [row cells, column cells, orientations]
  void write(const ImageAnalysis& analysis, std::span<double> out);

 private:
  static constexpr std::size_t kOrientations = 8;

  std::vector<CellShares> row_shares_;  ///< Of each row.
  std::vector<CellShares> col_shares_;  ///< Of each column.
  std::vector<double> of_row_;          ///< [column cells, orientations]
};

}  // namespace dermis::learn::recognition
