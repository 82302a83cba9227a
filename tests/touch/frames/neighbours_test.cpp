// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/frames/neighbours.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace dermis {
namespace {

using Taxels = std::vector<std::size_t>;

Taxels visited(const Neighbours& neighbours) {
  Taxels taxels;
  for (const std::size_t taxel : neighbours) taxels.push_back(taxel);
  return taxels;
}

TEST(Neighbours, are_the_taxel_and_the_8_around_it_in_rising_order) {
  EXPECT_EQ(visited(Neighbours(4, 5, 7)), (Taxels{1, 2, 3, 6, 7, 8, 11, 12, 13}));
}

TEST(Neighbours, are_fewer_at_edges_and_corners) {
  EXPECT_EQ(visited(Neighbours(4, 5, 0)), (Taxels{0, 1, 5, 6}));
  EXPECT_EQ(visited(Neighbours(4, 5, 9)), (Taxels{3, 4, 8, 9, 13, 14}));
  EXPECT_EQ(visited(Neighbours(4, 5, 19)), (Taxels{13, 14, 18, 19}));
  EXPECT_EQ(visited(Neighbours(1, 1, 0)), (Taxels{0}));
  EXPECT_EQ(visited(Neighbours(3, 1, 1)), (Taxels{0, 1, 2}));
  EXPECT_EQ(visited(Neighbours(1, 3, 2)), (Taxels{1, 2}));
}

TEST(Neighbours, reach_as_far_as_asked_on_rows_and_columns) {
  EXPECT_EQ(visited(Neighbours(4, 5, 7, {.row = 0, .column = 2})), (Taxels{5, 6, 7, 8, 9}));
  EXPECT_EQ(visited(Neighbours(4, 5, 7, {.row = 2, .column = 0})), (Taxels{2, 7, 12, 17}));
  EXPECT_EQ(visited(Neighbours(4, 5, 7, {.row = 0, .column = 0})), (Taxels{7}));
}

TEST(Neighbours, are_exactly_those_within_reach) {
  constexpr std::size_t kRows = 5;
  constexpr std::size_t kCols = 7;
  const auto distance = [](std::size_t a, std::size_t b) { return a > b ? a - b : b - a; };
  for (std::size_t taxel = 0; taxel < kRows * kCols; ++taxel) {
    for (const PerAxis<std::size_t> reach : {PerAxis<std::size_t>{1, 1}, {3, 1}, {1, 3}, {9, 9}}) {
      Taxels expected;
      for (std::size_t other = 0; other < kRows * kCols; ++other) {
        if (distance(other / kCols, taxel / kCols) > reach.row) continue;
        if (distance(other % kCols, taxel % kCols) <= reach.column) expected.push_back(other);
      }
      EXPECT_EQ(visited(Neighbours(kRows, kCols, taxel, reach)), expected)
          << "taxel " << taxel << ", " << reach.row << " rows, " << reach.column << " columns";
    }
  }
}

}  // namespace
}  // namespace dermis
