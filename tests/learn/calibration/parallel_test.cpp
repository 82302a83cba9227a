// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/calibration/parallel.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace dermis::learn::calibration {
namespace {

TEST(ParallelFor, calls_every_index_once) {
  std::vector<int> calls(10'000, 0);
  parallel_for(calls.size(), [&](std::size_t i) { ++calls[i]; });
  EXPECT_EQ(calls, std::vector<int>(10'000, 1));
}

TEST(ParallelFor, does_nothing_for_no_index) {
  parallel_for(0, [](std::size_t) { FAIL(); });
}

TEST(ParallelFor, nests) {
  std::vector<std::vector<int>> calls(20, std::vector<int>(20, 0));
  parallel_for(20, [&](std::size_t i) { parallel_for(20, [&](std::size_t j) { ++calls[i][j]; }); });
  EXPECT_EQ(calls, (std::vector<std::vector<int>>(20, std::vector<int>(20, 1))));
}

}  // namespace
}  // namespace dermis::learn::calibration
