// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/paper/ranks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

#include "support/thread_ranks.hpp"

namespace dermis::paper {
namespace {

using support::on_ranks;

TEST(Ranks, parts_follow_each_other_and_differ_by_one_at_most) {
  for (std::size_t ranks = 1; ranks <= 7; ++ranks) {
    for (const std::size_t items : {0U, 1U, 6U, 7U, 256U, 1000U}) {
      std::size_t next = 0;
      for (std::size_t rank = 0; rank < ranks; ++rank) {
        const Part part = part_of(items, rank, ranks);
        EXPECT_EQ(part.first, next);
        EXPECT_GE(part.count, items / ranks);
        EXPECT_LE(part.count, items / ranks + 1);
        next += part.count;
      }
      EXPECT_EQ(next, items);
    }
  }
}

TEST(Ranks, one_process_has_all_and_waits_for_nobody) {
  Ranks& alone = one_process();
  EXPECT_EQ(alone.count(), 1U);
  EXPECT_EQ(own_part(alone, 9).count, 9U);
  std::vector<int> values = {1, 2, 3};
  broadcast_list(alone, values);
  gather(alone, std::span(values));
  EXPECT_EQ(values, (std::vector<int>{1, 2, 3}));
}

TEST(Ranks, a_list_gets_the_size_of_that_of_the_root) {
  on_ranks(3, [](Ranks& ranks) {
    std::string text = ranks.rank() == 1 ? "from rank 1" : std::string(ranks.rank(), 'x');
    broadcast_list(ranks, text, 1);
    EXPECT_EQ(text, "from rank 1");
  });
}

TEST(Ranks, all_get_what_each_brings) {
  on_ranks(4, [](Ranks& ranks) {
    std::vector<std::size_t> values(10);
    const Part own = own_part(ranks, values.size());
    for (std::size_t k = own.first; k < own.first + own.count; ++k) values[k] = k;
    gather(ranks, std::span(values));
    std::vector<std::size_t> expected(10);
    std::iota(expected.begin(), expected.end(), std::size_t{0});
    EXPECT_EQ(values, expected);
  });
}

TEST(Ranks, the_error_of_the_first_rank_that_has_one_is_that_of_all) {
  on_ranks(3, [](Ranks& ranks) {
    EXPECT_TRUE(agreed(ranks, Done{}));
    Status own = Done{};
    if (ranks.rank() > 0) own = bad_field("steps", "of rank " + std::to_string(ranks.rank()));
    const Status all = agreed(ranks, own);
    ASSERT_FALSE(all);
    EXPECT_EQ(all.error().kind, ErrorKind::bad_input);
    EXPECT_EQ(all.error().message, "rank 1: steps: of rank 1");
  });
}

TEST(Ranks, who_is_not_started_by_mpirun_is_alone) {
  if (std::getenv("OMPI_COMM_WORLD_SIZE") != nullptr) GTEST_SKIP() << "mpirun has started this";
  const auto ranks = open_ranks();
  ASSERT_TRUE(ranks) << ranks.error().message;
  EXPECT_EQ((*ranks)->count(), 1U);
  EXPECT_EQ((*ranks)->rank(), 0U);
}

}  // namespace
}  // namespace dermis::paper
