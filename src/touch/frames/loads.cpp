// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/frames/loads.hpp"

namespace dermis {

std::string to_string(const TaxelRegion& region, const ArrayDescription& array) {
  if (region.taxel_count() == 1) return taxel_name(region.first_row, region.first_col);
  if (region == all_taxels(array)) return "all";
  return taxel_name(region.first_row, region.first_col) + ":" + taxel_name(region.last_row, region.last_col);
}

TaxelRegion all_taxels(const ArrayDescription& array) noexcept {
  return {0, 0, array.rows - 1, array.cols - 1};
}

std::vector<std::size_t> taxel_indices(const TaxelRegion& region, std::size_t cols) {
  std::vector<std::size_t> indices;
  indices.reserve(region.taxel_count());
  for (std::size_t row = region.first_row; row <= region.last_row; ++row) {
    for (std::size_t col = region.first_col; col <= region.last_col; ++col) indices.push_back(row * cols + col);
  }
  return indices;
}

}  // namespace dermis
