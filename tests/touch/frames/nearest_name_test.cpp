// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/frames/nearest_name.hpp"

#include <gtest/gtest.h>

namespace dermis {
namespace {

const std::set<std::string> kKnown = {"baud", "protocol", "rows", "cols"};

TEST(NearestName, counts_inserted_removed_and_replaced_characters) {
  EXPECT_EQ(nearest_name("boud", kKnown), "baud");
  EXPECT_EQ(nearest_name("baaud", kKnown), "baud");
  EXPECT_EQ(nearest_name("protcol", kKnown), "protocol");
  EXPECT_EQ(nearest_name("rows", kKnown), "rows");
}

TEST(NearestName, says_nothing_where_none_can_be_meant) {
  EXPECT_EQ(nearest_name("temperature", kKnown), "");
  EXPECT_EQ(nearest_name("x", kKnown), "");
  EXPECT_EQ(nearest_name(std::string(1000, 'r'), kKnown), "");
  EXPECT_EQ(nearest_name("rows", {}), "");
}

}  // namespace
}  // namespace dermis
