// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/calibration/calibration_plan.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "support/reference_array.hpp"

namespace dermis::learn::calibration {
namespace {

using support::reference_array;

TEST(CalibrationPlan, names_the_field_that_is_wrong) {
  const ArrayDescription array = reference_array(4, 4);
  ASSERT_TRUE(default_plan(array).validate(array));
  const auto expect_wrong = [&](const char* field, const std::function<void(CalibrationPlan&)>& spoil) {
    CalibrationPlan plan = default_plan(array);
    spoil(plan);
    const Status status = plan.validate(array);
    ASSERT_FALSE(status) << field;
    EXPECT_EQ(status.error().message.rfind(field, 0), 0U) << status.error().message;
  };
  expect_wrong("taxels", [](CalibrationPlan& plan) { plan.taxels = {}; });
  expect_wrong("taxels", [](CalibrationPlan& plan) { plan.taxels = {16}; });
  expect_wrong("taxels", [](CalibrationPlan& plan) { plan.taxels = {1, 2, 1}; });
  expect_wrong("weights_n", [](CalibrationPlan& plan) { plan.weights_n = {}; });
  expect_wrong("weights_n", [](CalibrationPlan& plan) { plan.weights_n = {0.0}; });
  expect_wrong("weights_n", [](CalibrationPlan& plan) { plan.weights_n = {5.0, 5.0}; });
  expect_wrong("weights_n", [](CalibrationPlan& plan) { plan.weights_n.assign(17, 1.0); });
  expect_wrong("unloaded_time", [](CalibrationPlan& plan) { plan.unloaded_time = Nanos{0}; });
  expect_wrong("hold_time", [](CalibrationPlan& plan) { plan.hold_time = std::chrono::seconds(31); });
}

TEST(CalibrationPlan, of_a_large_array_is_bounded) {
  const ArrayDescription array = reference_array(256, 256);
  CalibrationPlan plan = default_plan(array);
  EXPECT_TRUE(plan.validate(array));
  plan.taxels = taxels_with_stride(array, 4);
  EXPECT_FALSE(plan.validate(array));
}

TEST(CalibrationPlan, asks_for_no_press_where_the_sheet_has_no_taxel) {
  ArrayDescription array = reference_array(4, 4);
  array.absent = {0, 5};
  CalibrationPlan plan = default_plan(array);
  EXPECT_EQ(plan.taxels.size(), 14U);
  EXPECT_TRUE(plan.validate(array));
  plan.taxels = {4, 5};
  EXPECT_EQ(plan.validate(array).error().message, "taxels: the sheet has no r1c1");
}

TEST(CalibrationPlan, strides_leave_equal_edges) {
  const ArrayDescription array = reference_array(16, 7);
  const std::vector<std::size_t> taxels = taxels_with_stride(array, 4);
  EXPECT_EQ(taxels, (std::vector<std::size_t>{8, 12, 36, 40, 64, 68, 92, 96}));
  EXPECT_EQ(taxels_with_stride(array, 1).size(), 112U);
  EXPECT_EQ(taxels_with_stride(array, 1000).size(), 1U);
}

TEST(CalibrationPlan, keeps_more_of_every_press_the_fewer_weights_there_are) {
  const auto frames_with = [](std::size_t weights) {
    CalibrationPlan plan;
    plan.weights_n.assign(weights, 1.0);
    return plan.frames_per_press();
  };
  EXPECT_EQ(frames_with(1), 4U);
  EXPECT_EQ(frames_with(3), 4U);
  EXPECT_EQ(frames_with(4), 2U);
  EXPECT_EQ(frames_with(7), 2U);
  EXPECT_EQ(frames_with(8), 1U);
}

}  // namespace
}  // namespace dermis::learn::calibration
