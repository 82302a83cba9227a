// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/ros_messages/live_messages.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bytes/ros_messages/read_by_definition.hpp"
#include "support/allocation_guard.hpp"
#include "support/calibration_state.hpp"

// tests/out/websocket/npm_client_test.mjs reads the same messages with a reader that is not ours.
namespace dermis::bytes::ros_messages {
namespace {

using nlohmann::json;

constexpr Nanos kTime = std::chrono::seconds(1'790'000'000) + std::chrono::nanoseconds(123);

json stamp() {
  return {{"sec", 1'790'000'000}, {"nanosec", 123}};
}

json header() {
  return {{"stamp", stamp()}, {"frame_id", "suit"}};
}

json vector(double x, double y, double z) {
  return {{"x", x}, {"y", y}, {"z", z}};
}

json point_field(const char* name, int offset, int datatype) {
  return {{"name", name}, {"offset", offset}, {"datatype", datatype}, {"count", 1}};
}

TEST(LiveMessages, types_name_all_that_they_use) {
  for (const MessageType* type :
       {&point_cloud_type(), &contacts_type(), &statistics_type(), &calibration_state_type(), &diagnostics_type(),
        &transforms_type(), &classification_type(), &threat_type(), &wrench_type()}) {
    EXPECT_NE(type->definition.find("MSG: std_msgs/Header"), std::string::npos) << type->name;
    EXPECT_NE(type->definition.find("MSG: builtin_interfaces/Time"), std::string::npos) << type->name;
  }
}

TEST(LiveMessages, points_are_twenty_bytes_each) {
  const std::vector<TaxelPoint> points = {{1.0F, 2.0F, 3.0F, 4.0F, TaxelStatus::ok},
                                          {5.0F, 6.0F, 7.0F, 8.0F, TaxelStatus::line_fault}};
  std::vector<std::uint8_t> message;
  encode_points(points, kTime, "suit", message);
  json cloud = read_by_definition(point_cloud_type(), message);
  const auto data = cloud["data"].get<std::vector<std::uint8_t>>();
  cloud.erase("data");
  EXPECT_EQ(cloud, json({{"header", header()},
                         {"height", 1},
                         {"width", 2},
                         {"fields",
                          {point_field("x", 0, 7), point_field("y", 4, 7), point_field("z", 8, 7),
                           point_field("newtons", 12, 7), point_field("status", 16, 2)}},
                         {"is_bigendian", false},
                         {"point_step", 20},
                         {"row_step", 40},
                         {"is_dense", false}}));
  ASSERT_EQ(data.size(), 40U);
  float newtons = 0.0F;
  std::memcpy(&newtons, data.data() + 20 + 12, sizeof(newtons));
  EXPECT_EQ(newtons, 8.0F);
  EXPECT_EQ(data[20 + 16], 4U);
}

TEST(LiveMessages, contacts_stand_in_the_plane_and_in_the_suit) {
  ContactReport report;
  report.time = kTime;
  report.total_force_n = 7.0;
  report.sigma_total_n = 0.1;
  const Contact in_plane{9,
                         ContactPhase::release,
                         kTime,
                         {0.01, 0.02},
                         {0.03, 0.04},
                         {0.05, 0.06},
                         1.5,
                         0.25,
                         3e-4,
                         5e4,
                         4e4,
                         6e-3,
                         2e-3,
                         0.5,
                         5};
  SuitContact contact;
  contact.contact = in_plane;
  contact.place.position = {1.0, 2.0, 3.0};
  contact.place.normal = {0.0, 1.0, 0.0};
  contact.velocity = {0.1, 0.2, 0.3};
  const std::vector<SuitContact> contacts = {contact};
  std::vector<std::uint8_t> message;
  encode_contacts({"chest", report, contacts, Vector3{4.0, 5.0, 6.0}, {-0.5, 0.25, 3}}, "suit", message);
  const json expected_contact = {{"id", 9},
                                 {"phase", 2},
                                 {"onset_time", stamp()},
                                 {"x", 0.01},
                                 {"y", 0.02},
                                 {"sigma_x", 0.03},
                                 {"sigma_y", 0.04},
                                 {"velocity_x", 0.05},
                                 {"velocity_y", 0.06},
                                 {"force_n", 1.5},
                                 {"sigma_force_n", 0.25},
                                 {"area_m2", 3e-4},
                                 {"peak_pressure_pa", 5e4},
                                 {"mean_pressure_pa", 4e4},
                                 {"major_axis_m", 6e-3},
                                 {"minor_axis_m", 2e-3},
                                 {"angle_rad", 0.5},
                                 {"taxels", 5},
                                 {"position", vector(1.0, 2.0, 3.0)},
                                 {"normal", vector(0.0, 1.0, 0.0)},
                                 {"velocity", vector(0.1, 0.2, 0.3)}};
  EXPECT_EQ(read_by_definition(contacts_type(), message), json({{"header", header()},
                                                                {"array", "chest"},
                                                                {"total_force_n", 7.0},
                                                                {"sigma_total_n", 0.1},
                                                                {"has_centre_of_pressure", true},
                                                                {"centre_of_pressure", vector(4.0, 5.0, 6.0)},
                                                                {"touches", json::array({expected_contact})},
                                                                {"sum_n", -0.5},
                                                                {"sigma_sum_n", 0.25}}));
  encode_contacts({"chest", report, {}, {}}, "suit", message);
  EXPECT_EQ(read_by_definition(contacts_type(), message)["has_centre_of_pressure"], false);
}

TEST(LiveMessages, a_wrench_has_its_force_and_its_torque) {
  std::vector<std::uint8_t> message;
  encode_wrench({{1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}}, kTime, "suit", message);
  EXPECT_EQ(
      read_by_definition(wrench_type(), message),
      json({{"header", header()}, {"wrench", {{"force", vector(1.0, 2.0, 3.0)}, {"torque", vector(4.0, 5.0, 6.0)}}}}));
}

TEST(LiveMessages, a_calibration_state_has_all_of_its_fields) {
  CalibrationState state = support::calibration_state(kTime);
  state.missing_taxel = 4;
  std::vector<std::uint8_t> message;
  encode_calibration_state(state, "suit", message);
  EXPECT_EQ(read_by_definition(calibration_state_type(), message), json({{"header", header()},
                                                                         {"array", "hand"},
                                                                         {"stage", 2},
                                                                         {"message", "Press r1c0"},
                                                                         {"taxel", 8},
                                                                         {"weight_n", 5.0},
                                                                         {"reading", 1.75},
                                                                         {"hold_share", 0.5},
                                                                         {"presses_done", 3},
                                                                         {"presses_total", 12},
                                                                         {"median_relative_error", 0.04},
                                                                         {"taxel_presses", {1, 0, 2}},
                                                                         {"hint", 4},
                                                                         {"pressed_taxel", 7},
                                                                         {"unpressed_relative_error", 0.09},
                                                                         {"together_with", 5},
                                                                         {"together_reading", 1.5},
                                                                         {"missing_taxel", 4}}));
}

TEST(LiveMessages, what_is_not_known_of_a_calibration_is_told) {
  std::vector<std::uint8_t> message;
  encode_calibration_state({}, "suit", message);
  const json state = read_by_definition(calibration_state_type(), message);
  EXPECT_TRUE(std::isnan(state["median_relative_error"].get<double>()));
  EXPECT_EQ(state["pressed_taxel"], 4'294'967'295U);
  EXPECT_TRUE(std::isnan(state["unpressed_relative_error"].get<double>()));
  EXPECT_EQ(state["together_with"], 4'294'967'295U);
  EXPECT_TRUE(std::isnan(state["together_reading"].get<double>()));
  EXPECT_EQ(state["missing_taxel"], 4'294'967'295U);
}

TEST(LiveMessages, statistics_have_all_of_their_fields) {
  Statistics statistics;
  statistics.time = kTime;
  statistics.arrays = {{"chest", true, "the port is gone", 1, 2, 3, 4, 999.5, 2e-5, 1.5e-5, 6e-5, 31.5, 5.02, 7}};
  statistics.recording = true;
  statistics.recording_file = "r.mcap";
  statistics.recording_frames = 1ULL << 40U;
  statistics.clients = 3;
  statistics.client_drops = 5;
  statistics.recording_left_out = 6;
  statistics.frames_not_streamed = 8;
  std::vector<std::uint8_t> message;
  encode_statistics(statistics, "suit", message);
  EXPECT_EQ(read_by_definition(statistics_type(), message), json({{"header", header()},
                                                                  {"arrays",
                                                                   {{{"name", "chest"},
                                                                     {"ended", true},
                                                                     {"error", "the port is gone"},
                                                                     {"frames", 1},
                                                                     {"rejected", 2},
                                                                     {"lost", 3},
                                                                     {"damaged", 4},
                                                                     {"rate_hz", 999.5},
                                                                     {"jitter_s", 2e-5},
                                                                     {"latency_p50_s", 1.5e-5},
                                                                     {"latency_p99_s", 6e-5},
                                                                     {"temperature_celsius", 31.5},
                                                                     {"supply_v", 5.02},
                                                                     {"skipped", 7}}}},
                                                                  {"recording", true},
                                                                  {"recording_file", "r.mcap"},
                                                                  {"recording_frames", 1ULL << 40U},
                                                                  {"clients", 3},
                                                                  {"client_drops", 5},
                                                                  {"recording_left_out", 6},
                                                                  {"frames_not_streamed", 8}}));
}

TEST(LiveMessages, diagnoses_and_transforms_read_back) {
  const std::vector<Diagnosis> diagnoses = {
      {Diagnosis::Level::error, "chest", "gone", "skin", {{"row 3", "silent_row"}}}};
  std::vector<std::uint8_t> message;
  encode_diagnostics(diagnoses, kTime, "suit", message);
  const json value = {{"key", "row 3"}, {"value", "silent_row"}};
  const json status = {
      {"level", 2}, {"name", "chest"}, {"message", "gone"}, {"hardware_id", "skin"}, {"values", json::array({value})}};
  EXPECT_EQ(read_by_definition(diagnostics_type(), message),
            json({{"header", header()}, {"status", json::array({status})}}));

  const std::vector<Transform> transforms = {{"suit", "chest", {{1.0, 2.0, 3.0}, {0.1, 0.2, 0.3, 0.4}}}};
  encode_transforms(transforms, kTime, message);
  const Quaternion& turn = transforms[0].parent_from_child.rotation;
  const json rotation = {{"x", turn.x}, {"y", turn.y}, {"z", turn.z}, {"w", turn.w}};
  const json transform = {{"header", header()},
                          {"child_frame_id", "chest"},
                          {"transform", {{"translation", vector(1.0, 2.0, 3.0)}, {"rotation", rotation}}}};
  EXPECT_EQ(read_by_definition(transforms_type(), message), json({{"transforms", json::array({transform})}}));
}

TEST(LiveMessages, a_classification_has_its_results_in_their_order) {
  const std::vector<Hypothesis> results = {{"unknown", 1.0}, {"between classes", 0.0}, {"tap", 0.625}};
  std::vector<std::uint8_t> message;
  encode_classification(results, kTime, "suit", message);
  json expected = json::array();
  for (const Hypothesis& result : results) expected.push_back({{"class_id", result.class_id}, {"score", result.score}});
  EXPECT_EQ(read_by_definition(classification_type(), message), json({{"header", header()}, {"results", expected}}));
}

TEST(LiveMessages, a_threat_has_all_of_its_fields) {
  const Threat threat{
      kTime, "throat", "suit", "neck", "contact_force", Threat::State::latched, true, kTime, 25.5, 0.25, 30.5,
      20.0,  "N",      0.01,   0.02};
  std::vector<std::uint8_t> message;
  encode_threat(threat, message);
  EXPECT_EQ(read_by_definition(threat_type(), message), json({{"header", header()},
                                                              {"name", "throat"},
                                                              {"array", "suit"},
                                                              {"zone", "neck"},
                                                              {"quantity", "contact_force"},
                                                              {"state", 3},
                                                              {"changed", true},
                                                              {"crossed_time", stamp()},
                                                              {"value", 25.5},
                                                              {"sigma", 0.25},
                                                              {"worst", 30.5},
                                                              {"limit", 20.0},
                                                              {"unit", "N"},
                                                              {"x", 0.01},
                                                              {"y", 0.02}}));
}

TEST(LiveMessages, conductance_is_a_grid_like_force) {
  ConductanceFrame frame;
  frame.time = kTime;
  frame.siemens = {1e-3, 2e-3};
  frame.sigma_siemens = {1e-6, 2e-6};
  frame.taxels = {TaxelStatus::ok, TaxelStatus::saturated};
  std::vector<std::uint8_t> message;
  encode_conductance_grid(frame, {1, 2}, {}, "chest", message);
  const std::string bytes(message.begin(), message.end());
  EXPECT_NE(bytes.find("sigma_siemens"), std::string::npos);
  const auto last = std::vector<std::uint8_t>(message.end() - 18, message.end());
  EXPECT_EQ(std::bit_cast<float>(*reinterpret_cast<const std::array<std::uint8_t, 4>*>(last.data())), 1e-3F);
  EXPECT_EQ(last.back(), static_cast<std::uint8_t>(TaxelStatus::saturated));
}

TEST(LiveMessages, allocate_nothing_once_the_message_has_its_size) {
  if (!support::kAllocationsAreCounted) GTEST_SKIP() << "a sanitizer owns malloc";
  const std::vector<TaxelPoint> points(256);
  ContactReport report;
  const std::vector<SuitContact> contacts(3);
  std::vector<std::uint8_t> cloud;
  std::vector<std::uint8_t> touches;
  const auto encode = [&] {
    encode_points(points, kTime, "suit", cloud);
    encode_contacts({"chest", report, contacts, {}}, "suit", touches);
  };
  encode();
  const support::AllocationGuard guard;
  encode();
  EXPECT_EQ(guard.count(), 0U);
}

}  // namespace
}  // namespace dermis::bytes::ros_messages
