// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/frames/millimetres.hpp"

#include <gtest/gtest.h>

namespace dermis {
namespace {

TEST(Millimetres, a_whole_number_of_them_up_to_a_metre_comes_back_from_metres) {
  for (int mm = 0; mm <= 1000; ++mm) {
    EXPECT_EQ(mm, mm / kMillimetresPerMetre * kMillimetresPerMetre);
  }
}

}  // namespace
}  // namespace dermis
