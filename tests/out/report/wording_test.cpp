// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/out/report/wording.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace dermis::out::report {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(Wording, two_digits_round_up_into_the_next_power_of_ten) {
  EXPECT_EQ(two_digits(0.0), "0");
  EXPECT_EQ(two_digits(0.0584), "0.058");
  EXPECT_EQ(two_digits(2.44), "2.4");
  EXPECT_EQ(two_digits(9.96), "10");
  EXPECT_EQ(two_digits(51.2), "51");
  EXPECT_EQ(two_digits(2.5e6), "2.5e+06");
}

TEST(Wording, an_error_that_is_not_finite_is_no_force) {
  EXPECT_EQ(percent(0.024), "2.4 %");
  EXPECT_EQ(percent(kInfinity), "no force");
  EXPECT_EQ(newtons(0.031), "0.031 N");
  EXPECT_EQ(newtons(kNan), "no force");
}

TEST(Wording, a_fine_percentage_is_not_rounded_over_a_limit) {
  EXPECT_EQ(fine_percent(0.05004), "5.00\u00a0%");
  EXPECT_EQ(fine_percent(0.0502), "5.02\u00a0%");
  EXPECT_EQ(fine_percent(0.123), "12.3\u00a0%");
  EXPECT_EQ(fine_percent(kNan), "no force");
}

TEST(Wording, three_digits_or_a_dash) {
  EXPECT_EQ(three_digits(1.23456), "1.23");
  EXPECT_EQ(three_digits(kNan), "-");
}

TEST(Wording, counts_are_grouped_and_their_nouns_agree) {
  EXPECT_EQ(grouped(999), "999");
  EXPECT_EQ(grouped(33751296), "33,751,296");
  EXPECT_EQ(counted(1, "frame"), "1 frame");
  EXPECT_EQ(counted(2000, "frame"), "2,000 frames");
  EXPECT_EQ(steps(2000.0), "2,000 steps");
  EXPECT_EQ(steps(kNan), "- steps");
}

TEST(Wording, estimators_are_words_of_print) {
  EXPECT_EQ(estimator_words("raw_lookup"), "raw look-up");
  EXPECT_EQ(estimator_words("dermis"), "dermis");
}

}  // namespace
}  // namespace dermis::out::report
