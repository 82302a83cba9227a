// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/paper/peaks_reproduction.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace dermis::paper {
namespace {

constexpr PeaksEffort kLittle{2, 200, 8, 2, 2, 7, 30};

TEST(PeaksReproduction, is_that_of_the_papers_function_and_the_same_each_time) {
  std::vector<double> shares;
  const PeaksReproduction found = reproduce_peaks(kLittle, [&](double share) { shares.push_back(share); });
  EXPECT_EQ(found.goal, 0.001);
  EXPECT_NEAR(found.variance, 3.41, 0.2);
  EXPECT_EQ(found.side, 61U);
  EXPECT_EQ(found.target.size(), 61U * 61U);
  EXPECT_EQ(found.output.size(), 61U * 61U);
  ASSERT_EQ(found.by_hidden.size(), 3U);
  EXPECT_EQ(found.by_hidden.front().hidden, 5U);
  EXPECT_GE(found.by_hidden.front().starts, kLittle.paper_size_starts);
  EXPECT_EQ(found.adaptive_rate_starts, kLittle.adaptive_rate_starts);
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  EXPECT_EQ(shares.back(), 1.0);

  const PeaksReproduction again = reproduce_peaks(kLittle, [](double) {});
  EXPECT_EQ(again.output, found.output);
  EXPECT_EQ(again.adaptive_rate_curve.value, found.adaptive_rate_curve.value);
}

TEST(PeaksReproduction, the_drawn_network_is_the_best_of_the_papers_size) {
  const PeaksReproduction found = reproduce_peaks(kLittle, [](double) {});
  double square = 0.0;
  for (std::size_t k = 0; k < found.target.size(); ++k) {
    square += (found.output[k] - found.target[k]) * (found.output[k] - found.target[k]);
  }
  EXPECT_NEAR(square / static_cast<double>(found.target.size()) / found.by_hidden.front().best_mse, 1.0, 1e-9);
}

}  // namespace
}  // namespace dermis::paper
