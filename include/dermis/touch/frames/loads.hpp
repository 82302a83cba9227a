// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "dermis/touch/frames/array_description.hpp"

namespace dermis {

/// A rectangle of taxels, both ends inclusive.
struct TaxelRegion {
  std::size_t first_row = 0;
  std::size_t first_col = 0;
  std::size_t last_row = 0;
  std::size_t last_col = 0;

  [[nodiscard]] std::size_t taxel_count() const noexcept {
    return (last_row - first_row + 1) * (last_col - first_col + 1);
  }
  bool operator==(const TaxelRegion&) const = default;
};

enum class LoadKind {
  force,     ///< Total force over the taxels of the region [N]; of several taxels only the sum is known.
  pressure,  ///< Uniform pressure on each taxel of the region [Pa].
};

/// One line of loads.csv: a load that was known while a frame was taken. Taxels that no load of a labelled
/// frame names are unloaded; frames without a load are unlabelled.
struct Load {
  std::size_t frame = 0;  ///< Index of the frame, from 0.
  LoadKind kind = LoadKind::force;
  TaxelRegion where;
  double value = 0.0;  ///< [N] for force, [Pa] for pressure; >= 0.
};

/// Place of the only contact on a strip (an array of one row or one column) in a frame.
struct TouchPosition {
  std::size_t frame = 0;  ///< Index of the frame, from 0.
  double along_m = 0.0;   ///< From the centre of the first taxel, along the strip [m].
};

/// "r3c5", "r0c0:r3c3", or "all" where the region is the whole array.
[[nodiscard]] std::string to_string(const TaxelRegion& region, const ArrayDescription& array);

/// The whole array as a region.
[[nodiscard]] TaxelRegion all_taxels(const ArrayDescription& array) noexcept;

/// Row-major indices of the taxels of a region of an array with `cols` columns.
[[nodiscard]] std::vector<std::size_t> taxel_indices(const TaxelRegion& region, std::size_t cols);

}  // namespace dermis
