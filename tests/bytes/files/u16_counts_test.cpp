// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/u16_counts.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace dermis::bytes::files {
namespace {

TEST(U16Counts, whole_counts_fit) {
  EXPECT_TRUE(fit_u16({}));
  EXPECT_TRUE(fit_u16(std::vector{0.0F, 1.0F, 4095.0F, 65535.0F}));
}

TEST(U16Counts, a_count_that_would_lose_a_bit_does_not_fit) {
  for (const float count : {-0.0F, -1.0F, 0.5F, 65536.0F, std::numeric_limits<float>::quiet_NaN(),
                            std::numeric_limits<float>::infinity()}) {
    EXPECT_FALSE(fit_u16(std::vector{1.0F, count})) << count;
  }
}

}  // namespace
}  // namespace dermis::bytes::files
