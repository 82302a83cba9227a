// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/frames/quantile.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "dermis/touch/frames/random.hpp"

namespace dermis {
namespace {

TEST(Quantile, is_the_smallest_value_that_the_share_does_not_exceed) {
  const std::vector<double> values = {40.0, 10.0, 30.0, 20.0};
  EXPECT_EQ(quantile(values, 0.0), 10.0);
  EXPECT_EQ(quantile(values, 0.25), 10.0);
  EXPECT_EQ(quantile(values, 0.26), 20.0);
  EXPECT_EQ(quantile(values, 0.5), 20.0);
  EXPECT_EQ(quantile(values, 0.95), 40.0);
  EXPECT_EQ(quantile(values, 1.0), 40.0);
  EXPECT_EQ(quantile(std::vector<float>{7.0F}, 0.5), 7.0F);
}

TEST(Quantile, agrees_with_the_definition_on_random_values) {
  constexpr std::uint64_t kSeed = 1;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  Random random(kSeed);
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<double> values(1 + random.below(30));
    for (double& value : values) value = static_cast<double>(random.below(10));
    const double share = random.uniform(0.0, 1.0);
    const double found = quantile(values, share);
    const auto count = [&](auto is_counted) {
      return static_cast<double>(std::count_if(values.begin(), values.end(), is_counted));
    };
    const auto size = static_cast<double>(values.size());
    EXPECT_GE(count([&](double value) { return value <= found; }), share * size);
    EXPECT_LT(count([&](double value) { return value < found; }), share * size);
  }
}

TEST(UpperMedian, is_the_middle_value_or_the_upper_of_two) {
  EXPECT_EQ(upper_median(std::vector<double>{3.0, 1.0, 2.0}), 2.0);
  EXPECT_EQ(upper_median(std::vector<double>{4.0, 1.0, 3.0, 2.0}), 3.0);
  EXPECT_EQ(upper_median(std::vector<float>{5.0F}), 5.0F);
}

}  // namespace
}  // namespace dermis
