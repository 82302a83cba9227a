// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/messages/live_messages.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "dermis/messages/cdr.hpp"
#include "support/allocation_guard.hpp"

// tests/stream/npm_client_test.mjs reads the same messages with a reader that is not ours, by their definitions.
namespace dermis::messages {
namespace {

constexpr Nanos kTime = std::chrono::seconds(1'790'000'000) + std::chrono::nanoseconds(123);

void expect_header(CdrReader& reader, const std::string& frame_id) {
  EXPECT_EQ(reader.read<std::int32_t>(), 1'790'000'000);
  EXPECT_EQ(reader.read<std::uint32_t>(), 123U);
  EXPECT_EQ(reader.read_text(), frame_id);
}

TEST(LiveMessages, TypesNameAllThatTheyUse) {
  for (const MessageType* type : {&point_cloud_type(), &contacts_type(), &statistics_type(), &calibration_state_type(),
                                  &diagnostics_type(), &transforms_type()}) {
    EXPECT_NE(type->definition.find("MSG: std_msgs/Header"), std::string::npos) << type->name;
    EXPECT_NE(type->definition.find("MSG: builtin_interfaces/Time"), std::string::npos) << type->name;
  }
}

TEST(LiveMessages, PointsAreTwentyBytesEach) {
  const std::vector<TaxelPoint> points = {{1.0F, 2.0F, 3.0F, 4.0F, TaxelStatus::ok},
                                          {5.0F, 6.0F, 7.0F, 8.0F, TaxelStatus::line_fault}};
  std::vector<std::uint8_t> message;
  encode_points(points, kTime, "suit", message);
  CdrReader reader(message);
  expect_header(reader, "suit");
  EXPECT_EQ(reader.read<std::uint32_t>(), 1U);
  EXPECT_EQ(reader.read<std::uint32_t>(), 2U);
  const auto fields = reader.read<std::uint32_t>();
  for (std::uint32_t field = 0; field < fields; ++field) {
    EXPECT_FALSE(reader.read_text().empty());
    EXPECT_EQ(reader.read<std::uint32_t>(), 4 * field);
    EXPECT_EQ(reader.read<std::uint8_t>(), field < 4 ? 7 : 2);
    EXPECT_EQ(reader.read<std::uint32_t>(), 1U);
  }
  EXPECT_EQ(reader.read<std::uint8_t>(), 0U);
  EXPECT_EQ(reader.read<std::uint32_t>(), 20U);
  EXPECT_EQ(reader.read<std::uint32_t>(), 40U);
  const auto data = reader.read_bytes();
  ASSERT_EQ(data.size(), 40U);
  float newtons = 0.0F;
  std::memcpy(&newtons, data.data() + 20 + 12, sizeof(newtons));
  EXPECT_EQ(newtons, 8.0F);
  EXPECT_EQ(data[20 + 16], static_cast<std::uint8_t>(TaxelStatus::line_fault));
  EXPECT_EQ(reader.read<std::uint8_t>(), 0U) << "forces may be NaN";
  EXPECT_TRUE(reader.good());
}

TEST(LiveMessages, ContactsStandInThePlaneAndInTheSuit) {
  ContactReport report;
  report.time = kTime;
  report.total_force_n = 7.0;
  report.sigma_total_n = 0.1;
  SuitContact contact;
  contact.contact.id = 9;
  contact.contact.phase = ContactPhase::release;
  contact.contact.onset = kTime;
  contact.contact.position = {0.01, 0.02};
  contact.contact.taxels = 5;
  contact.place.position = {1.0, 2.0, 3.0};
  contact.velocity = {0.1, 0.2, 0.3};
  const std::vector<SuitContact> contacts = {contact};
  std::vector<std::uint8_t> message;
  encode_contacts({"chest", report, contacts, Vector3{4.0, 5.0, 6.0}}, "suit", message);
  CdrReader reader(message);
  expect_header(reader, "suit");
  EXPECT_EQ(reader.read_text(), "chest");
  for (const double expected : {7.0, 0.1}) EXPECT_EQ(reader.read<double>(), expected);
  EXPECT_EQ(reader.read<std::uint8_t>(), 1U);
  for (const double expected : {4.0, 5.0, 6.0}) EXPECT_EQ(reader.read<double>(), expected);
  EXPECT_EQ(reader.read<std::uint32_t>(), 1U);
  EXPECT_EQ(reader.read<std::uint32_t>(), 9U);
  EXPECT_EQ(reader.read<std::uint8_t>(), 2U);
  EXPECT_EQ(reader.read<std::int32_t>(), 1'790'000'000);
  EXPECT_EQ(reader.read<std::uint32_t>(), 123U);
  for (const double expected : {0.01, 0.02}) EXPECT_EQ(reader.read<double>(), expected);
  for (int skipped = 0; skipped < 12; ++skipped) static_cast<void>(reader.read<double>());
  EXPECT_EQ(reader.read<std::uint32_t>(), 5U);
  for (const double expected : {1.0, 2.0, 3.0, 0.0, 0.0, 1.0, 0.1, 0.2, 0.3})
    EXPECT_EQ(reader.read<double>(), expected);
  EXPECT_TRUE(reader.good());
}

TEST(LiveMessages, WhatIsNotKnownOfACalibrationIsTold) {
  CalibrationState state;
  state.time = kTime;
  state.array = "hand";
  state.stage = CalibrationState::Stage::pressing;
  state.taxel_presses = {1, 0, 2};
  state.hint = 4;
  std::vector<std::uint8_t> message;
  encode_calibration_state(state, "suit", message);
  CdrReader reader(message);
  expect_header(reader, "suit");
  EXPECT_EQ(reader.read_text(), "hand");
  EXPECT_EQ(reader.read<std::uint8_t>(), 2U);
  EXPECT_EQ(reader.read_text(), "");
  EXPECT_EQ(reader.read<std::uint32_t>(), 0U);
  for (const double expected : {0.0, 1.0, 0.0}) EXPECT_EQ(reader.read<double>(), expected);
  for (int skipped = 0; skipped < 2; ++skipped) static_cast<void>(reader.read<std::uint32_t>());
  EXPECT_TRUE(std::isnan(reader.read<double>()));
  EXPECT_EQ(reader.read_bytes().size(), 3U);
  EXPECT_EQ(reader.read<std::uint8_t>(), 4U);
  EXPECT_EQ(reader.read<std::uint32_t>(), 4'294'967'295U);
  EXPECT_TRUE(std::isnan(reader.read<double>()));
  EXPECT_TRUE(reader.good());
}

TEST(LiveMessages, StatisticsHealthAndTransformsReadBack) {
  std::vector<std::uint8_t> message;
  Statistics statistics;
  statistics.time = kTime;
  statistics.arrays.resize(2);
  statistics.arrays[1].name = "b";
  statistics.recording = true;
  statistics.recording_file = "r.mcap";
  statistics.recording_frames = 1ULL << 40U;
  statistics.clients = 3;
  encode_statistics(statistics, "suit", message);
  CdrReader reader(message);
  expect_header(reader, "suit");
  EXPECT_EQ(reader.read<std::uint32_t>(), 2U);
  for (int array = 0; array < 2; ++array) {
    EXPECT_EQ(reader.read_text(), array == 1 ? "b" : "");
    EXPECT_EQ(reader.read<std::uint8_t>(), 0U);
    EXPECT_EQ(reader.read_text(), "");
    for (int skipped = 0; skipped < 4; ++skipped) EXPECT_EQ(reader.read<std::uint64_t>(), 0U);
    for (int skipped = 0; skipped < 6; ++skipped) static_cast<void>(reader.read<double>());
  }
  EXPECT_EQ(reader.read<std::uint8_t>(), 1U);
  EXPECT_EQ(reader.read_text(), "r.mcap");
  EXPECT_EQ(reader.read<std::uint64_t>(), 1ULL << 40U);
  EXPECT_EQ(reader.read<std::uint32_t>(), 3U);
  EXPECT_TRUE(reader.good());

  const std::vector<Diagnosis> diagnoses = {
      {Diagnosis::Level::error, "chest", "gone", "skin", {{"row 3", "silent_row"}}}};
  encode_diagnostics(diagnoses, kTime, "suit", message);
  CdrReader health(message);
  expect_header(health, "suit");
  EXPECT_EQ(health.read<std::uint32_t>(), 1U);
  EXPECT_EQ(health.read<std::uint8_t>(), 2U);
  for (const char* expected : {"chest", "gone", "skin"}) EXPECT_EQ(health.read_text(), expected);
  EXPECT_EQ(health.read<std::uint32_t>(), 1U);
  for (const char* expected : {"row 3", "silent_row"}) EXPECT_EQ(health.read_text(), expected);
  EXPECT_TRUE(health.good());

  const std::vector<Transform> transforms = {{"suit", "chest", {{1.0, 2.0, 3.0}, {0.0, 0.0, 1.0, 0.0}}}};
  encode_transforms(transforms, kTime, message);
  CdrReader transform(message);
  EXPECT_EQ(transform.read<std::uint32_t>(), 1U);
  expect_header(transform, "suit");
  EXPECT_EQ(transform.read_text(), "chest");
  for (const double expected : {1.0, 2.0, 3.0, 0.0, 0.0, 1.0, 0.0}) EXPECT_EQ(transform.read<double>(), expected);
  EXPECT_TRUE(transform.good());
}

TEST(LiveMessages, ConductanceIsAGridLikeForce) {
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

TEST(LiveMessages, AllocateNothingOnceTheMessageHasItsSize) {
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
}  // namespace dermis::messages
