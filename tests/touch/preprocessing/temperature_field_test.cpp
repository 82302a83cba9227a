// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/preprocessing/temperature_field.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace dermis::touch::preprocessing {
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
  const std::vector<TemperatureSensor> places = sensors_on_each_taxel(8, 6);
  for (std::size_t taxel = 0; taxel < taxels.size(); ++taxel) {
    const auto& [row, col] = places[taxel];
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

TEST(TemperatureField, sensors_without_a_reading_count_as_if_they_were_not_there) {
  const std::vector<TemperatureSensor> five{{0, 0}, {0, 5}, {7, 0}, {7, 5}, {3.5, 2.0}};
  const auto expect_same = [](const std::vector<float>& a, const std::vector<float>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t k = 0; k < a.size(); ++k) EXPECT_NEAR(a[k], b[k], 0.02);
  };
  expect_same(interpolated(array_with(five, 10.0), {20.0F, kNan, 24.0F, 28.0F, 23.0F}),
              interpolated(array_with({five[0], five[2], five[3], five[4]}, 10.0), {20.0F, 24.0F, 28.0F, 23.0F}));
  expect_same(interpolated(array_with(five, 10.0), {20.0F, 3e38F, 24.0F, kNan, -2000.0F}),
              interpolated(array_with({five[0], five[2]}, 10.0), {20.0F, 24.0F}));
}

TEST(TemperatureField, a_taxel_of_a_map_without_a_reading_has_the_mean_of_its_neighbours) {
  const ArrayDescription array = array_with(sensors_on_each_taxel(8, 6));
  std::vector<float> sensors;
  for (const auto& [row, col] : sensors_on_each_taxel(8, 6)) {
    sensors.push_back(static_cast<float>(20.0 + row + 0.5 * col));
  }
  std::vector<float> some = sensors;
  for (const std::size_t taxel : {7U, 20U}) some[taxel] = kNan;
  some[0] = some[1] = some[6] = kNan;
  const std::vector<float> taxels = interpolated(array, some);
  EXPECT_FLOAT_EQ(taxels[20], sensors[20]);
  EXPECT_FLOAT_EQ(taxels[7], 0.5F * (sensors[8] + sensors[13])) << "of those that read";
  EXPECT_GT(taxels[0], 22.0F) << "none reads: the mean of the sheet";
}

TEST(TemperatureField, a_gradient_runs_from_end_to_end_of_each_axis) {
  for (const auto& [rows, cols] : {std::pair<std::size_t, std::size_t>{4, 32}, {2, 2}, {3, 4}}) {
    ArrayDescription array = array_with({}, 10.0);
    array.rows = rows;
    array.cols = cols;
    double squares = 0.0;
    for (const TemperatureSensor& taxel : sensors_on_each_taxel(rows, cols)) {
      squares += std::pow(taxel.row / static_cast<double>(rows - 1) - 0.5, 2) +
                 std::pow(taxel.col / static_cast<double>(cols - 1) - 0.5, 2);
    }
    const double expected = 10.0 * std::sqrt(squares / static_cast<double>(rows * cols));
    EXPECT_NEAR(TemperatureField(array).sigma_celsius(), expected, 0.06 * expected) << rows << "x" << cols;
  }
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
}  // namespace dermis::touch::preprocessing
