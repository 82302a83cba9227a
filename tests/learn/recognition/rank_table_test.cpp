// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/recognition/answer/rank_table.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace dermis::learn::recognition {
namespace {

TEST(RankTable, ranks_rise_from_0_to_1_and_on_with_the_logarithm) {
  std::vector<double> values(1000);
  std::iota(values.begin(), values.end(), 1.0);
  const std::vector<float> table = rank_table(values);
  EXPECT_LE(table.size(), 256U);
  EXPECT_EQ(rank_in(table, 0.5), 0.0);
  EXPECT_NEAR(rank_in(table, 250.0), 0.25, 0.01);
  EXPECT_NEAR(rank_in(table, 999.0), 1.0, 0.01);
  EXPECT_NEAR(rank_in(table, 2000.0), 1.0 + std::log(2.0), 1e-6);
  double last = 0.0;
  for (double value = 0.0; value < 1500.0; value += 0.7) {
    const double rank = rank_in(table, value);
    EXPECT_GE(rank, last);
    last = rank;
  }
}

TEST(RankTable, of_equal_values_ranks_what_exceeds_them) {
  const std::vector<float> table = rank_table({0.0, 0.0, 0.0});
  EXPECT_EQ(rank_in(table, 0.0), 0.0);
  EXPECT_EQ(rank_in(table, 1.0), 1.0);
  EXPECT_EQ(rank_in(rank_table({0.1, 0.1, 0.1, 0.4}), 0.1), 0.0);
}

TEST(RankTable, ranks_each_value_among_the_others) {
  const std::vector<double> ranks = ranks_among_others({3.0, 1.0, 8.0, 4.0});
  ASSERT_EQ(ranks.size(), 4U);
  EXPECT_EQ(ranks[0], rank_in(rank_table({1.0, 4.0, 8.0}), 3.0));
  EXPECT_EQ(ranks[1], 0.0);
  EXPECT_NEAR(ranks[2], 1.0 + std::log(2.0), 1e-6) << "the largest goes beyond all others, as a new one may";
  EXPECT_EQ(ranks[3], rank_in(rank_table({1.0, 3.0, 8.0}), 4.0));
  EXPECT_EQ(ranks_among_others({5.0}), std::vector<double>{1.0});
  EXPECT_EQ(ranks_among_others({2.0, 2.0, 2.0}), (std::vector<double>{0.0, 0.0, 0.0}));
}

}  // namespace
}  // namespace dermis::learn::recognition
