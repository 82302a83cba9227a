// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/frames/touch.hpp"

#include <gtest/gtest.h>

namespace dermis {
namespace {

TEST(TouchedAbove, is_a_multiple_of_the_unloaded_conductance_and_the_noise) {
  EXPECT_DOUBLE_EQ(touched_above(2e-6, 1e-7, 5.0), 6.5e-6);
  EXPECT_DOUBLE_EQ(touched_above(0.0, 1e-7, 20.0), 2e-6);
  EXPECT_DOUBLE_EQ(touched_above(2e-6, 0.0, 20.0), 6e-6);
}

}  // namespace
}  // namespace dermis
