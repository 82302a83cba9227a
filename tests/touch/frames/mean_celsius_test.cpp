// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/frames/mean_celsius.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <span>
#include <vector>

namespace dermis {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinite = std::numeric_limits<float>::infinity();

RawFrame frame_of(std::optional<double> celsius, std::vector<float> sensors) {
  RawFrame frame;
  frame.temperature_celsius = celsius;
  frame.sensor_celsius = std::move(sensors);
  return frame;
}

TEST(MeanCelsius, is_that_of_the_array_where_there_is_one) {
  EXPECT_EQ(mean_celsius(frame_of(25.0, {})), 25.0);
  EXPECT_EQ(mean_celsius(frame_of(25.0, {20.0F, 21.0F})), 25.0);
}

TEST(MeanCelsius, is_the_mean_of_the_sensors_with_a_reading) {
  EXPECT_EQ(mean_celsius(frame_of({}, {20.0F, kNone, 23.0F, kInfinite})), 21.5);
  EXPECT_EQ(mean_celsius(frame_of(std::numeric_limits<double>::quiet_NaN(), {20.0F})), 20.0);
}

TEST(MeanCelsius, is_that_of_sensors_alone) {
  const std::vector<float> sensors{20.0F, kNone, 23.0F};
  EXPECT_EQ(mean_celsius(std::span(sensors)), 21.5);
  EXPECT_EQ(mean_celsius(std::span(sensors).subspan(1, 1)), std::nullopt);
}

TEST(MeanCelsius, is_none_without_any_reading) {
  EXPECT_EQ(mean_celsius(frame_of({}, {})), std::nullopt);
  EXPECT_EQ(mean_celsius(frame_of({}, {kNone, -kInfinite})), std::nullopt);
  EXPECT_EQ(mean_celsius(frame_of(std::numeric_limits<double>::infinity(), {})), std::nullopt);
}

}  // namespace
}  // namespace dermis
