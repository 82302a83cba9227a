// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/frames/number_text.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace dermis {
namespace {

TEST(NumberText, has_as_many_significant_digits_as_asked_for_and_no_zeros_at_the_end) {
  EXPECT_EQ(significant_digits(1.66666, 3), "1.67");
  EXPECT_EQ(significant_digits(15.0, 3), "15");
  EXPECT_EQ(significant_digits(0.5, 2), "0.5");
  EXPECT_EQ(significant_digits(12345678.0, 2), "1.2e+07");
  EXPECT_EQ(significant_digits(0.000012, 2), "1.2e-05");
  EXPECT_EQ(significant_digits(-std::numeric_limits<double>::infinity(), 4), "-inf");
}

TEST(NumberText, tells_tenths_of_any_number) {
  EXPECT_EQ(tenths(298.15), "298.1");
  EXPECT_EQ(tenths(300.0), "300.0");
  EXPECT_EQ(tenths(-std::numeric_limits<double>::max()).size(), 312U);
}

TEST(NumberText, is_short_where_that_tells_the_number_from_all_others) {
  EXPECT_EQ(shortest_text(0.0F), "0");
  EXPECT_EQ(shortest_text(-57.0F), "-57");
  EXPECT_EQ(shortest_text(4095.5F), "4095.5");
  EXPECT_EQ(shortest_text(0.1F), "0.1");
  EXPECT_EQ(shortest_text(100000.0F), "100000");
  EXPECT_EQ(shortest_text(16777215.0F), "16777215");
}

TEST(NumberText, writes_large_numbers_without_and_extreme_ones_with_an_exponent) {
  EXPECT_EQ(shortest_text(4294967296.0F), "4294967300");
  EXPECT_EQ(shortest_text(-1e11F), "-100000000000");
  EXPECT_EQ(shortest_text(1e16F), "1e+16");
  EXPECT_EQ(shortest_text(1.5e-5F), "1.5e-05");
}

}  // namespace
}  // namespace dermis
