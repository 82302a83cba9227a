// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/frames/loads.hpp"

#include <gtest/gtest.h>

namespace dermis {
namespace {

ArrayDescription array_of(std::size_t rows, std::size_t cols) {
  ArrayDescription array;
  array.rows = rows;
  array.cols = cols;
  return array;
}

TEST(TaxelRegion, counts_both_ends) {
  EXPECT_EQ((TaxelRegion{1, 1, 1, 1}).taxel_count(), 1U);
  EXPECT_EQ((TaxelRegion{0, 1, 2, 2}).taxel_count(), 6U);
}

TEST(TaxelRegion, of_all_taxels_is_the_whole_array) {
  EXPECT_EQ(all_taxels(array_of(3, 4)), (TaxelRegion{0, 0, 2, 3}));
}

TEST(TaxelRegion, is_written_as_in_loads_csv) {
  const ArrayDescription array = array_of(4, 4);
  EXPECT_EQ(to_string(TaxelRegion{3, 2, 3, 2}, array), "r3c2");
  EXPECT_EQ(to_string(TaxelRegion{0, 0, 3, 2}, array), "r0c0:r3c2");
  EXPECT_EQ(to_string(TaxelRegion{0, 0, 3, 3}, array), "all");
}

TEST(TaxelRegion, lists_its_taxels_row_by_row) {
  EXPECT_EQ(taxel_indices({1, 2, 2, 3}, 5), (std::vector<std::size_t>{7, 8, 12, 13}));
}

}  // namespace
}  // namespace dermis
