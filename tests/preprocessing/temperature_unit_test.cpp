// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/preprocessing/temperature_unit.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace dermis::preprocessing {
namespace {

TEST(TemperatureUnit, kelvin_is_what_no_sheet_has_in_degrees_celsius) {
  EXPECT_TRUE(looks_like_kelvin(293.15));
  EXPECT_TRUE(looks_like_kelvin(233.15)) << "-40 C";
  for (const double celsius : {-40.0, 0.0, 23.0, 150.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_FALSE(looks_like_kelvin(celsius)) << celsius;
  }
}

}  // namespace
}  // namespace dermis::preprocessing
