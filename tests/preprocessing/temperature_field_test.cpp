// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/preprocessing/temperature_field.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace dermis::preprocessing {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

ArrayDescription array_with(std::vector<TemperatureSensor> sensors, double gradient_celsius = 0.0) {
  ArrayDescription array;
  array.rows = 8;
  array.cols = 6;
  array.temperature_sensors = std::move(sensors);
  array.temperature_gradient_celsius = gradient_celsius;
  return array;
}

std::vector<float> interpolated(const ArrayDescription& array, const std::vector<float>& sensors) {
  TemperatureField field(array);
  std::vector<float> taxels;
  EXPECT_TRUE(field.interpolate(sensors, taxels));
  return taxels;
}

TEST(TemperatureField, one_sensor_is_the_temperature_of_every_taxel) {
  for (const float celsius : interpolated(array_with({{2.0, 3.5}}), {31.25F})) EXPECT_FLOAT_EQ(celsius, 31.25F);
}

TEST(TemperatureField, sensors_of_one_temperature_give_it_to_every_taxel) {
  const std::vector<TemperatureSensor> corners{{0, 0}, {0, 5}, {7, 0}, {7, 5}, {3.5, 2.0}};
  for (const float celsius : interpolated(array_with(corners), {20, 20, 20, 20, 20})) EXPECT_NEAR(celsius, 20.0, 1e-3);
}

TEST(TemperatureField, four_corners_tell_a_gradient) {
  const std::vector<TemperatureSensor> corners{{0, 0}, {0, 5}, {7, 0}, {7, 5}};
  const auto plane = [](double row, double col) { return static_cast<float>(18.0 + 0.8 * row - 1.1 * col); };
  const std::vector<float> taxels =
      interpolated(array_with(corners), {plane(0, 0), plane(0, 5), plane(7, 0), plane(7, 5)});
  for (std::size_t taxel = 0; taxel < taxels.size(); ++taxel) {
    const auto row = static_cast<double>(taxel / 6);
    const auto col = static_cast<double>(taxel % 6);
    EXPECT_NEAR(taxels[taxel], plane(row, col), 0.15);
  }
}

TEST(TemperatureField, a_sensor_on_each_taxel_gives_its_reading_exactly) {
  ArrayDescription array = array_with(sensors_on_each_taxel(8, 6));
  std::vector<float> sensors;
  for (std::size_t taxel = 0; taxel < array.taxel_count(); ++taxel)
    sensors.push_back(20.0F + 0.37F * std::sin(static_cast<float>(taxel)));
  EXPECT_EQ(interpolated(array, sensors), sensors);
  EXPECT_EQ(TemperatureField(array).sigma_celsius(), 0.0);
}

TEST(TemperatureField, a_sensor_without_a_reading_has_the_mean_of_the_others) {
  const ArrayDescription array = array_with({{0, 0}, {7, 5}, {3, 3}});
  EXPECT_EQ(interpolated(array, {20.0F, kNan, 24.0F}), interpolated(array, {20.0F, 22.0F, 24.0F}));
}

TEST(TemperatureField, sensors_without_any_reading_or_of_another_number_give_nothing) {
  TemperatureField field(array_with({{0, 0}, {7, 5}}));
  std::vector<float> taxels{1.0F};
  EXPECT_FALSE(field.interpolate(std::vector<float>{kNan, kNan}, taxels));
  EXPECT_TRUE(taxels.empty());
  EXPECT_FALSE(field.interpolate(std::vector<float>{20.0F}, taxels));
  EXPECT_FALSE(field.interpolate(std::vector<float>{}, taxels));
}

TEST(TemperatureField, more_sensors_leave_less_of_a_gradient_unknown) {
  const double none_told = TemperatureField(array_with({{3.5, 2.5}})).sigma_celsius();
  const double one = TemperatureField(array_with({{3.5, 2.5}}, 10.0)).sigma_celsius();
  const double four = TemperatureField(array_with({{0, 0}, {0, 5}, {7, 0}, {7, 5}}, 10.0)).sigma_celsius();
  EXPECT_EQ(none_told, 0.0);
  EXPECT_GT(one, 2.0);
  EXPECT_LT(four, one / 1.5);
  EXPECT_EQ(TemperatureField(array_with({}, 10.0)).sigma_celsius(), one);
}

}  // namespace
}  // namespace dermis::preprocessing
