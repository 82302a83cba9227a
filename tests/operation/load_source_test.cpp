// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/operation/load_source.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <limits>

#include "force_mat.hpp"

namespace dermis::operation {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// Loads of the pressed taxel, and whether the frame was one of the tare.
std::vector<std::pair<float, bool>> loads_of(const LoadInput& input) {
  std::vector<std::pair<float, bool>> loads;
  Result<LoadSource> source = LoadSource::open(input);
  EXPECT_TRUE(source) << error_of(source);
  while (source && source->next().value()) loads.emplace_back(source->loads()[kPressed], source->is_tare());
  return loads;
}

recognition::Layout layout(double least_reading) {
  recognition::Layout layout;
  layout.least_reading = least_reading;
  return layout;
}

TEST(CheckLoads, wants_forces_for_classes_of_forces_and_readings_for_those_of_readings) {
  EXPECT_TRUE(check_loads(layout(recognition::kLeastNewtons), "c", "model"));
  EXPECT_TRUE(check_loads(layout(1.0), "c", ""));
  const Status without = check_loads(layout(recognition::kLeastNewtons), "c", "");
  ASSERT_FALSE(without);
  EXPECT_EQ(without.error().message, "c: its classes were learned from forces; name the --model of the array");
  const Status with = check_loads(layout(1.0), "c", "model");
  ASSERT_FALSE(with);
  EXPECT_NE(with.error().message.find("leave --model out"), std::string::npos);
}

TEST(LoadSource, gives_readings_without_a_model_and_0_where_there_is_no_load) {
  const MatFiles mat;
  const auto loads = loads_of({.from = mat.write("frames.csv", pressed({3.0F, -2.0F, kNan}))});
  EXPECT_EQ(loads, (std::vector<std::pair<float, bool>>{{3.0F, false}, {0.0F, false}, {0.0F, false}}));
}

TEST(LoadSource, gives_newtons_by_a_model_and_tells_its_array) {
  const MatFiles mat;
  Result<LoadSource> source =
      LoadSource::open({.from = mat.write("frames.csv", pressed({3.0F})), .model = mat.model()});
  ASSERT_TRUE(source && source->next().value());
  EXPECT_NEAR(source->loads()[kPressed], 3.0F, 1e-4F);
  EXPECT_EQ(source->time(), std::chrono::seconds(1));
  EXPECT_EQ(source->array(), (recognition::SensedArray{"mat", 3, 4, 0, 4.0, 10.0}));
  EXPECT_FALSE(source->is_live());
}

TEST(LoadSource, takes_the_mean_of_the_first_second_for_unloaded) {
  const MatFiles mat;
  std::vector<float> readings(100, 40.0F);
  for (std::size_t i = 0; i < readings.size(); i += 2) readings[i] = 42.0F;
  readings.insert(readings.end(), {50.0F, 41.5F, 20.0F});
  const auto loads = loads_of({.from = mat.write("frames.csv", pressed(readings)), .tare = true});
  ASSERT_EQ(loads.size(), 103U);
  for (std::size_t i = 0; i < 100; ++i) EXPECT_EQ(loads[i], (std::pair(0.0F, true))) << i;
  EXPECT_EQ(loads[100], (std::pair(9.0F, false)));
  EXPECT_EQ(loads[101], (std::pair(0.5F, false)));
  EXPECT_EQ(loads[102], (std::pair(0.0F, false)));
}

TEST(LoadSource, tares_the_forces_of_a_model) {
  const MatFiles mat;
  std::vector<float> readings(110, 2.0F);
  readings.insert(readings.end(), 5, 7.0F);
  const auto loads = loads_of({.from = mat.write("frames.csv", pressed(readings)), .model = mat.model(), .tare = true});
  ASSERT_EQ(loads.size(), 115U);
  EXPECT_EQ(loads.front(), (std::pair(0.0F, true)));
  EXPECT_FALSE(loads.back().second);
  EXPECT_NEAR(loads.back().first, 5.0F, 1e-3F);
}

TEST(UnloadedReadings, takes_ten_frames_of_a_slow_source_but_no_more_than_ten_seconds) {
  const auto frames_taken = [](Nanos period) {
    UnloadedReadings unloaded;
    RawFrame frame;
    frame.counts = {1.0F};
    std::size_t taken = 0;
    while (unloaded.add(frame)) {
      ++taken;
      frame.time += period;
    }
    return taken;
  };
  EXPECT_EQ(frames_taken(std::chrono::milliseconds(500)), 10U);
  EXPECT_EQ(frames_taken(std::chrono::seconds(4)), 3U);
}

}  // namespace
}  // namespace dermis::operation
