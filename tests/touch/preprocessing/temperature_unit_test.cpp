// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/preprocessing/temperature_unit.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace dermis::touch::preprocessing {
namespace {

TEST(TemperatureUnit, kelvin_is_what_no_sheet_has_in_degrees_celsius) {
  EXPECT_TRUE(looks_like_kelvin(293.15));
  EXPECT_TRUE(looks_like_kelvin(233.15)) << "-40 C";
  for (const double celsius : {-40.0, 0.0, 23.0, 150.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_FALSE(looks_like_kelvin(celsius)) << celsius;
  }
}

TEST(TemperatureUnit, kelvin_is_found_in_the_temperature_of_a_frame_and_in_its_sensors) {
  RawFrame frame;
  EXPECT_EQ(kelvin_in(frame), std::nullopt);
  frame.sensor_celsius = {20.0F, 293.5F};
  EXPECT_EQ(kelvin_in(frame), 293.5);
  frame.temperature_celsius = 300.0;
  EXPECT_EQ(kelvin_in(frame), 300.0);
  frame.temperature_celsius = 20.0;
  frame.sensor_celsius = {20.0F, std::numeric_limits<float>::quiet_NaN()};
  EXPECT_EQ(kelvin_in(frame), std::nullopt);
}

}  // namespace
}  // namespace dermis::touch::preprocessing
