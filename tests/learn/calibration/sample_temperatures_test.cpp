// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/calibration/sample_temperatures.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <utility>

namespace dermis::learn::calibration {
namespace {

/// 201 samples, evenly from 10 C on.
SampleDatabase rising_temperatures(double span_celsius) {
  SampleDatabase database;
  for (std::size_t k = 0; k <= 200; ++k) {
    database.samples.emplace_back().temperature_celsius = 10.0 + span_celsius * static_cast<double>(k) / 200.0;
  }
  return database;
}

TEST(SampleTemperatures, is_not_stretched_by_a_glitch_of_the_sensor) {
  SampleDatabase database = rising_temperatures(20.0);
  database.samples.front().temperature_celsius = -1e3;
  const SampleTemperatures temperatures = sample_temperatures(database);
  EXPECT_TRUE(temperatures.is_input);
  EXPECT_NEAR(temperatures.span.centre_celsius, 20.0, 1e-9);
  EXPECT_NEAR(temperatures.span.half_span_celsius, 9.8, 1e-9);
}

TEST(SampleTemperatures, is_no_input_where_it_is_narrow) {
  constexpr double kLeast = SampleTemperatures::kLeastSpanCelsius;
  EXPECT_FALSE(sample_temperatures(rising_temperatures(kLeast)).is_input);  // less the percent at either end
  EXPECT_TRUE(sample_temperatures(rising_temperatures(1.1 * kLeast)).is_input);
}

TEST(SampleTemperatures, is_no_input_where_a_sample_has_no_temperature) {
  SampleDatabase database = rising_temperatures(20.0);
  database.samples[7].temperature_celsius.reset();
  EXPECT_FALSE(sample_temperatures(database).is_input);
}

TEST(SampleTemperatures, of_a_map_are_no_wider_than_what_one_taxel_has_seen) {
  SampleDatabase database = rising_temperatures(1.0);
  database.array.rows = 1;
  database.array.cols = 2;
  for (Sample& sample : database.samples) {
    const auto mean = static_cast<float>(*sample.temperature_celsius);
    sample.taxel_celsius = {mean - 5.0F, mean + 5.0F};  // a gradient that stays
  }
  EXPECT_FALSE(sample_temperatures(database).is_input);
  EXPECT_LT(sample_temperatures(database).span.half_span_celsius, 0.51);
  for (std::size_t k = 0; k < database.samples.size(); k += 2) {
    std::swap(database.samples[k].taxel_celsius[0], database.samples[k].taxel_celsius[1]);
  }
  EXPECT_TRUE(sample_temperatures(database).is_input);
  EXPECT_NEAR(sample_temperatures(database).span.half_span_celsius, 5.5, 0.1);
}

}  // namespace
}  // namespace dermis::learn::calibration
