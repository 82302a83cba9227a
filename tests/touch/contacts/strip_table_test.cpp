// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/contacts/strip_table.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace dermis::touch::contacts {
namespace {

const StripTable kTable{{0.002, 0.004, 0.008}, {0.0, 0.006, 0.006}, 0.0005};

TEST(StripTable, is_straight_between_its_knots_and_constant_beyond) {
  EXPECT_DOUBLE_EQ(kTable.at(0.003).position_m, 0.003);
  EXPECT_DOUBLE_EQ(kTable.at(0.003).slope, 3.0);
  EXPECT_DOUBLE_EQ(kTable.at(0.006).position_m, 0.006);
  EXPECT_DOUBLE_EQ(kTable.at(0.006).slope, 0.0);
  EXPECT_DOUBLE_EQ(kTable.at(-1.0).position_m, 0.0);
  EXPECT_DOUBLE_EQ(kTable.at(1.0).position_m, 0.006);
}

TEST(StripTable, is_consistent_where_its_numbers_can_be_used) {
  EXPECT_TRUE(kTable.is_consistent());
  EXPECT_FALSE((StripTable{{0.0}, {0.0}, 0.0}.is_consistent()));
  EXPECT_FALSE((StripTable{{0.0, 1.0}, {0.0}, 0.0}.is_consistent()));
  EXPECT_FALSE((StripTable{{0.0, 0.0}, {0.0, 1.0}, 0.0}.is_consistent()));
  EXPECT_FALSE((StripTable{{0.0, 1.0}, {1.0, 0.0}, 0.0}.is_consistent()));
  EXPECT_FALSE((StripTable{{0.0, 1.0}, {0.0, 1.0}, -1.0}.is_consistent()));
  EXPECT_FALSE((StripTable{{0.0, std::numeric_limits<double>::quiet_NaN()}, {0.0, 1.0}, 0.0}.is_consistent()));
}

}  // namespace
}  // namespace dermis::touch::contacts
