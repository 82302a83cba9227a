// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/calibration/plan_request.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <vector>

#include "learn/calibration/simulated.hpp"

namespace dermis::learn::calibration {
namespace {

using std::chrono::milliseconds;

CalibrationPlan plan_of(const std::string& json) {
  const auto request = plan_request_from_json(json);
  EXPECT_TRUE(request) << request.error().message;
  const auto plan = request->plan(reference_array(4, 4));
  EXPECT_TRUE(plan) << plan.error().message;
  return *plan;
}

std::string error_of(const std::string& json) {
  const auto request = plan_request_from_json(json);
  return request ? "" : request.error().message;
}

TEST(PlanRequest, takes_the_default_plan_for_what_is_not_asked_for) {
  const CalibrationPlan plan = plan_of("{}");
  const CalibrationPlan standard = default_plan(reference_array(4, 4));
  EXPECT_EQ(plan.taxels, standard.taxels);
  EXPECT_EQ(plan.weights_n, standard.weights_n);
  EXPECT_EQ(plan.hold_time, standard.hold_time);
}

TEST(PlanRequest, reads_all_fields) {
  const auto request = plan_request_from_json(
      R"({"array": "chest", "weights_n": [5, 0.5], "taxels": [3, 0], "unloaded_s": 0.5, "hold_s": 0.25})");
  ASSERT_TRUE(request) << request.error().message;
  EXPECT_EQ(request->array, "chest");
  const auto plan = request->plan(reference_array(4, 4));
  ASSERT_TRUE(plan) << plan.error().message;
  EXPECT_EQ(plan->weights_n, (std::vector<double>{5.0, 0.5}));
  EXPECT_EQ(plan->taxels, (std::vector<std::size_t>{3, 0}));
  EXPECT_EQ(plan->unloaded_time, milliseconds(500));
  EXPECT_EQ(plan->hold_time, milliseconds(250));
}

TEST(PlanRequest, knows_all_taxels_and_strides) {
  EXPECT_EQ(plan_of(R"({"taxels": "all"})").taxels.size(), 16U);
  EXPECT_EQ(plan_of(R"({"taxels": {"stride": 2}})").taxels, (std::vector<std::size_t>{0, 2, 8, 10}));
}

TEST(PlanRequest, names_the_field_that_is_wrong) {
  EXPECT_NE(error_of(R"({"weight_n": [1]})").find("did you mean 'weights_n'?"), std::string::npos);
  for (const char* json : {R"({"weights_n": 5})", R"({"weights_n": ["5"]})"}) {
    EXPECT_EQ(error_of(json).rfind("weights_n:", 0), 0U) << json;
  }
  for (const char* json :
       {R"({"taxels": "some"})", R"({"taxels": [-1]})", R"({"taxels": [1.5]})", R"({"taxels": {"stride": 0}})",
        R"({"taxels": {"stride": 4, "x": 1}})", R"({"taxels": {"stride": 1e300}})", R"({"taxels": null})"}) {
    EXPECT_EQ(error_of(json).rfind("taxels:", 0), 0U) << json;
  }
  EXPECT_EQ(error_of(R"({"hold_s": 1e300})").rfind("hold_s:", 0), 0U);
  EXPECT_EQ(error_of(R"({"array": 1})").rfind("array:", 0), 0U);
}

TEST(PlanRequest, refuses_what_is_no_object_or_too_long) {
  for (const char* json : {"", "[]", "{", "nan", "{\"array\": \"\xff\"}"}) EXPECT_NE(error_of(json), "") << json;
  EXPECT_NE(error_of("{\"array\": \"" + std::string(300'000, 'x') + "\"}"), "");
}

TEST(PlanRequest, leaves_the_ranges_to_the_plan) {
  const auto request = plan_request_from_json(R"({"taxels": [16]})");
  ASSERT_TRUE(request) << request.error().message;
  EXPECT_FALSE(request->plan(reference_array(4, 4)));
}

}  // namespace
}  // namespace dermis::learn::calibration
