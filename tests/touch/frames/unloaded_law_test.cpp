// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/frames/unloaded_law.hpp"

#include <gtest/gtest.h>

namespace dermis {
namespace {

TEST(UnloadedLaw, is_linear_in_the_temperature_within_the_span_and_constant_beyond) {
  const UnloadedLaw law{{1e-5, 2e-5}, {0.0, -1e-7}, {25.0, 10.0}};
  const auto at = [&](double celsius) { return law.at(1, law.temperature.offset(celsius)); };
  EXPECT_DOUBLE_EQ(at(25.0), 2e-5);
  EXPECT_DOUBLE_EQ(at(30.0), 1.95e-5);
  EXPECT_DOUBLE_EQ(at(35.0), 1.9e-5);
  EXPECT_DOUBLE_EQ(at(80.0), 1.9e-5);
  EXPECT_DOUBLE_EQ(at(-40.0), 2.1e-5);
  EXPECT_EQ(law.at(0, law.temperature.offset(30.0)), 1e-5);
}

TEST(UnloadedLaw, excess_is_what_is_above_it) {
  const UnloadedLaw law{{2e-5}, {1e-7}, {20.0, 15.0}};
  EXPECT_NEAR(law.excess(0, 5e-4, 4.0), 5e-4 - law.at(0, 4.0), 1e-18);
  EXPECT_LT(law.excess(0, 2e-5, 4.0), 0.0);
}

TEST(TemperatureSpan, of_one_temperature_gives_no_offset) {
  const TemperatureSpan span;
  EXPECT_EQ(span.offset(20.0), 0.0);
  EXPECT_EQ(span.offset(35.0), 0.0);
  EXPECT_EQ(span.offset(-5.0), 0.0);
}

}  // namespace
}  // namespace dermis
