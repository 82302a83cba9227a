// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/sources/simulated_calibration.hpp"

#include <gtest/gtest.h>

#include <string>

namespace dermis::live::sources {
namespace {

Result<SimulatedCalibration> simulate(const std::string& uri) {
  return simulate_calibration(bytes::devices::parse_source_uri(uri).value());
}

TEST(SimulatedCalibration, loads_the_array_of_the_uri) {
  const Result<SimulatedCalibration> rig = simulate("sim:contacts?rate=100&rows=2&cols=3");
  ASSERT_TRUE(rig) << rig.error().message;
  EXPECT_EQ(rig->array.rows, 2U);
  EXPECT_EQ(rig->array.cols, 3U);
  ASSERT_FALSE(rig->loads.empty());
  EXPECT_LT(rig->loads.back().frame, rig->frames.size());
  EXPECT_EQ(rig->loads.back().where.taxel_count(), 6U);
}

TEST(SimulatedCalibration, loads_the_material_of_the_uri) {
  const auto strongest = [](const std::string& uri) { return simulate(uri).value().frames.back().counts.back(); };
  EXPECT_GT(strongest("sim:contacts?rows=2&cols=3&gain=2"), strongest("sim:contacts?rows=2&cols=3"));
}

TEST(SimulatedCalibration, refuses_what_the_simulator_refuses) {
  const Result<SimulatedCalibration> rig = simulate("sim:contacts?memory=elephant");
  ASSERT_FALSE(rig);
  EXPECT_NE(rig.error().message.find("elephant"), std::string::npos) << rig.error().message;
}

}  // namespace
}  // namespace dermis::live::sources
