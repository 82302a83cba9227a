// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "recognising/array_forces.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <limits>

#include "support/force_mat.hpp"

namespace dermis::recognising {
namespace {

using support::error_of;
using support::kPressed;
using support::kShape;
using support::MatFiles;
using support::pressed;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// Loads of the pressed taxel, and whether the frame was one of the tare.
std::vector<std::pair<float, bool>> loads_of(const ArrayForceInput& input) {
  std::vector<std::pair<float, bool>> loads;
  Result<ArrayForces> source = ArrayForces::open(input);
  EXPECT_TRUE(source) << error_of(source);
  while (source && source->next().value()) loads.emplace_back(source->loads()[kPressed], source->is_tare());
  return loads;
}

TEST(ArrayForces, gives_readings_without_a_model_and_0_where_there_is_no_load) {
  const MatFiles mat;
  const auto loads = loads_of({.from = mat.write("frames.csv", pressed({3.0F, -2.0F, kNan}))});
  EXPECT_EQ(loads, (std::vector<std::pair<float, bool>>{{3.0F, false}, {0.0F, false}, {0.0F, false}}));
}

TEST(ArrayForces, gives_newtons_by_a_model_and_tells_its_array) {
  const MatFiles mat;
  Result<ArrayForces> source =
      ArrayForces::open({.from = mat.write("frames.csv", pressed({3.0F})), .model = mat.model()});
  ASSERT_TRUE(source && source->next().value());
  EXPECT_NEAR(source->loads()[kPressed], 3.0F, 1e-4F);
  EXPECT_EQ(source->time(), std::chrono::seconds(1));
  EXPECT_EQ(source->array(), (learn::recognition::SensedArray{"mat", 3, 4, 0, 4.0, 10.0}));
  EXPECT_FALSE(source->is_live());
}

TEST(ArrayForces, tell_at_the_end_that_most_frames_had_no_force) {
  const MatFiles mat;
  std::vector<RawFrame> frames = pressed({1.0F, 1.0F, 1.0F});
  for (const std::size_t lost : {0U, 2U}) frames[lost].counts.assign(kShape.taxel_count(), NAN);
  std::vector<std::string> losses;
  ArrayForceInput input{.from = mat.write("frames.csv", frames), .model = mat.model()};
  input.source.loss = [&](const std::string& line) { losses.push_back(line); };
  Result<ArrayForces> source = ArrayForces::open(input);
  ASSERT_TRUE(source) << source.error().message;
  while (source->next().value()) EXPECT_TRUE(losses.empty());
  ASSERT_EQ(losses.size(), 1U);
  EXPECT_TRUE(losses[0].starts_with(input.from + ": 2 of 3 frames have no force: ")) << losses[0];
}

TEST(ArrayForces, takes_the_mean_of_the_first_second_for_unloaded) {
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

TEST(ArrayForces, tares_the_forces_of_a_model) {
  const MatFiles mat;
  std::vector<float> readings(110, 2.0F);
  readings.insert(readings.end(), 5, 7.0F);
  ArrayForceInput input = {.from = mat.write("frames.csv", pressed(readings)), .model = mat.model(), .tare = true};
  Result<ArrayForces> refused = ArrayForces::open(input);
  ASSERT_TRUE(refused);
  Result<bool> more = true;
  while (more && *more) more = refused->next();
  ASSERT_FALSE(more);
  EXPECT_EQ(more.error().message,
            input.from + ": not tared: r1c1 reads 2 N: take it off and tare again, or force the tare");
  input.tare_force = true;
  const auto loads = loads_of(input);
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

/// Frames at 1.00, 1.01 and 1.02 s.
HeldForces held(const MatFiles& mat, bool tare = false) {
  Result<HeldForces> array =
      HeldForces::open({.from = mat.write("frames.csv", pressed({1.0F, 2.0F, 3.0F})), .tare = tare, .source = {}});
  EXPECT_TRUE(array) << error_of(array);
  return *std::move(array);
}

float load_at(HeldForces& array, int milliseconds) {
  EXPECT_TRUE(array.move_to(std::chrono::milliseconds(milliseconds)));
  return array.loads()[kPressed];
}

TEST(HeldForces, are_those_of_the_last_frame_that_is_not_later) {
  const MatFiles mat;
  HeldForces array = held(mat);
  EXPECT_EQ(array.array().rows, kShape.rows);
  EXPECT_EQ(load_at(array, 995), 0.0F);
  EXPECT_EQ(load_at(array, 1000), 1.0F);
  EXPECT_EQ(load_at(array, 1009), 1.0F);
  EXPECT_EQ(load_at(array, 1025), 3.0F);
  EXPECT_EQ(load_at(array, 1520), 3.0F);
  EXPECT_EQ(array.silent(), 0U);
}

TEST(HeldForces, are_none_after_half_a_second_without_a_frame) {
  const MatFiles mat;
  HeldForces array = held(mat);
  EXPECT_EQ(load_at(array, 0), 0.0F);
  EXPECT_EQ(load_at(array, 500), 0.0F);
  EXPECT_EQ(array.silent(), 0U);
  EXPECT_EQ(load_at(array, 501), 0.0F);
  EXPECT_EQ(array.silent(), 1U);
  EXPECT_EQ(load_at(array, 1010), 2.0F);
  EXPECT_EQ(load_at(array, 1521), 0.0F);
  EXPECT_EQ(array.silent(), 2U);
}

TEST(HeldForces, belong_to_the_tare_before_their_first_frame) {
  const MatFiles mat;
  EXPECT_FALSE(held(mat).is_tare());
  HeldForces array = held(mat, true);
  EXPECT_TRUE(array.is_tare());
  EXPECT_EQ(load_at(array, 1020), 0.0F);
  EXPECT_TRUE(array.is_tare());
}

TEST(HeldForces, need_a_frame) {
  const MatFiles mat;
  const std::string empty = mat.write_two("two.mcap", pressed({1.0F}), {}) + "#right";
  EXPECT_EQ(error_of(HeldForces::open({.from = empty, .source = {}})), empty + ": has no frame");
}

}  // namespace
}  // namespace dermis::recognising
