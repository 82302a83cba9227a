// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/calibration/uncalibrated_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "dermis/touch/pipeline/pipeline.hpp"
#include "learn/calibration/simulated.hpp"

namespace dermis::learn::calibration {
namespace {

void expect_readings_without_forces(const ArrayDescription& array) {
  const touch::pipeline::Model model = uncalibrated_model(array);
  ASSERT_TRUE(model.networks.is_consistent());
  auto pipeline = touch::pipeline::Pipeline::create(model);
  ASSERT_TRUE(pipeline) << pipeline.error().message;
  RawFrame raw;
  raw.counts.assign(array.taxel_count(), 100.0F);
  ForceFrame force;
  pipeline->process(raw, force);
  for (std::size_t taxel = 0; taxel < array.taxel_count(); ++taxel) {
    EXPECT_TRUE(std::isnan(force.newtons[taxel]));
    EXPECT_EQ(force.taxels[taxel], TaxelStatus::dead);
    EXPECT_GT(pipeline->conductance().siemens[taxel], 0.0);
  }
}

TEST(UncalibratedModel, shows_conductances_and_no_forces) {
  expect_readings_without_forces(reference_array(4, 3));
}

TEST(UncalibratedModel, takes_readings_as_they_are_where_the_circuit_is_unknown) {
  ArrayDescription array = reference_array(4, 3);
  array.readout.load_ohm.assign(3, kFitOhm);
  expect_readings_without_forces(array);
  array.readout.circuit = Circuit::automatic;
  array.readout.drive_ohm.clear();
  array.readout.load_ohm.clear();
  expect_readings_without_forces(array);
}

TEST(UncalibratedModel, has_the_forces_that_the_readings_are) {
  ArrayDescription array;
  array.rows = array.cols = 2;
  array.readout.circuit = Circuit::none;
  array.readout.quantity = Quantity::force;
  const touch::pipeline::Model model = uncalibrated_model(array);
  EXPECT_EQ(model.networks.dead, std::vector<std::uint8_t>(4, 0));
}

}  // namespace
}  // namespace dermis::learn::calibration
