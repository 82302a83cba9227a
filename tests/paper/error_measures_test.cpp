// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/paper/error_measures.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace dermis::paper {
namespace {

const std::vector<double> kTargets = {1.0, 2.0, 3.0, 4.0};
const std::vector<double> kOutputs = {1.5, 2.0, 1.0, 5.0};  // differences -0.5, 0, 2, -1: squares 0.25, 0, 4, 1

TEST(ErrorMeasures, of_one_pattern_eq_5) {
  EXPECT_EQ(pattern_error<double>(std::span(kTargets).first(2), std::span(kOutputs).first(2)), 0.125);
  EXPECT_EQ(pattern_error<double>(std::span(kTargets).last(2), std::span(kOutputs).last(2)), 2.5);
}

TEST(ErrorMeasures, of_all_patterns_eq_6_is_the_sum_of_eq_5) {
  EXPECT_EQ(total_error<double>(kTargets, kOutputs), 0.125 + 2.5);
}

TEST(ErrorMeasures, mean_square_eq_2_is_twice_eq_6_over_the_number_of_values) {
  EXPECT_EQ(mean_square_error<double>(kTargets, kOutputs), 5.25 / 4.0);
  EXPECT_EQ(mean_square_error<double>(kTargets, kTargets), 0.0);
}

TEST(ErrorMeasures, sum_floats_in_double_precision) {
  const std::vector<float> targets(1'000'000, 0.1F);
  const std::vector<float> outputs(targets.size(), 0.0F);
  const double square = static_cast<double>(0.1F) * static_cast<double>(0.1F);
  EXPECT_NEAR(mean_square_error<float>(targets, outputs) / square, 1.0, 1e-9);
}

TEST(ErrorMeasures, show_what_is_not_a_number) {
  std::vector<double> outputs = kOutputs;
  outputs[2] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isnan(total_error<double>(kTargets, outputs)));
  EXPECT_TRUE(std::isnan(mean_square_error<double>(kTargets, outputs)));
}

}  // namespace
}  // namespace dermis::paper
