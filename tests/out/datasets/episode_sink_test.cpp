// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/out/datasets/episode_sink.hpp"

#include <gtest/gtest.h>

namespace dermis::out::datasets {
namespace {

TEST(Column, has_a_name_and_a_size) {
  const Column sigma{"chest", "sigma", ColumnType::float32, {5, 2, 3}, {"window", "rows", "cols"}};
  EXPECT_EQ(sigma.name(), "chest_sigma");
  EXPECT_EQ(sigma.row_bytes(), 120U);
  EXPECT_EQ((Column{"chest", "", ColumnType::boolean, {1}, {}}.name()), "chest");
  EXPECT_EQ((Column{"", "time_ns", ColumnType::int64, {1}, {}}.row_bytes()), 8U);
}

}  // namespace
}  // namespace dermis::out::datasets
