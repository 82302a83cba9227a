// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
// written_messages: prints messages of each type, a line each, as JSON: its type and definition, its bytes in hex, and
// its fields by the definition.
#include <fmt/core.h>

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "bytes/ros_messages/read_by_definition.hpp"
#include "dermis/bytes/ros_messages/live_messages.hpp"
#include "dermis/bytes/ros_messages/ros_messages.hpp"
#include "support/calibration_state.hpp"

namespace dermis::bytes::ros_messages {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr Nanos kTime = std::chrono::seconds(1'790'000'000) + std::chrono::nanoseconds(123);
constexpr FrameShape kShape{2, 3};

void print(const MessageType& type, const Bytes& message) {
  std::string hex;
  for (const std::uint8_t byte : message) hex += fmt::format("{:02x}", byte);
  const nlohmann::json line = {{"type", type.name},
                               {"definition", type.definition},
                               {"cdr", hex},
                               {"fields", read_by_definition(type, message)}};
  std::printf("%s\n", line.dump().c_str());
}

RawFrame raw_frame() {
  RawFrame frame;
  frame.time = kTime;
  frame.counts = {1, 2, 258, 4, 5, 65535};
  frame.temperature_celsius = 31.5;
  frame.sensor_celsius = {30.5F, 32.5F};
  frame.supply_v = 5.02;
  frame.acquisition.sequence = 1ULL << 40U;
  frame.acquisition.device_time = Nanos(-7);
  frame.acquisition.lost_before = 3;
  return frame;
}

ForceFrame force_frame() {
  ForceFrame frame;
  frame.time = kTime;
  frame.status = FrameStatus::saturated;
  frame.newtons = {0.5F, 1.5F, -0.25F, 0.0F, 3.0F, 7.5F};
  frame.sigma_newtons = {0.1F, 0.2F, 0.3F, 0.4F, 0.5F, 0.6F};
  frame.taxels.assign(kShape.rows * kShape.cols, TaxelStatus::ok);
  frame.taxels[1] = TaxelStatus::saturated;
  return frame;
}

void print_frames(Bytes& message) {
  const RawFrame raw = raw_frame();
  encode_image(raw, kShape, "chest", message);
  print(image_type(), message);
  encode_value_image(force_frame().newtons, kTime, kShape, "chest", message);
  print(image_type(), message);
  encode_temperature(31.5, kTime, "chest", message);
  print(temperature_type(), message);
  encode_acquisition(raw, message);
  print(acquisition_type(), message);
  encode_raw_frame(raw, kShape, "chest", message);
  print(raw_frame_type(), message);
  encode_grid(force_frame(), kShape, {0.01, 0.02}, "chest", message);
  print(grid_type(), message);
  encode_frame_status(force_frame(), message);
  print(frame_status_type(), message);
}

SuitContact contact() {
  SuitContact contact;
  contact.contact = {9,
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
  contact.place.position = {1.0, 2.0, 3.0};
  contact.place.normal = {0.0, 1.0, 0.0};
  contact.velocity = {0.1, 0.2, 0.3};
  return contact;
}

void print_contacts(Bytes& message) {
  ContactReport report;
  report.time = kTime;
  report.total_force_n = 7.0;
  report.sigma_total_n = 0.1;
  const std::vector<SuitContact> contacts = {contact(), contact()};
  for (const std::size_t count : {0U, 1U, 2U}) {
    encode_contacts({"chest", report, std::span(contacts).first(count), Vector3{4.0, 5.0, 6.0}, {-0.5, 0.25, 3}},
                    "suit", message);
    print(contacts_type(), message);
  }
  encode_points(std::vector<TaxelPoint>{{1.0F, 2.0F, 3.0F, 4.0F, TaxelStatus::ok}}, kTime, "suit", message);
  print(point_cloud_type(), message);
  encode_wrench({{1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}}, kTime, "suit", message);
  print(wrench_type(), message);
  encode_transforms(std::vector<Transform>{{"suit", "chest", {{1.0, 2.0, 3.0}, {0.1, 0.2, 0.3, 0.4}}}}, kTime, message);
  print(transforms_type(), message);
}

Statistics statistics() {
  Statistics statistics;
  statistics.time = kTime;
  statistics.arrays = {{"chest", true, "the port is gone", 1, 2, 3, 4, 999.5, 2e-5, 1.5e-5, 6e-5, 31.5, 5.02, 7}};
  statistics.recording = true;
  statistics.recording_file = "r.mcap";
  statistics.recording_frames = 1ULL << 40U;
  statistics.clients = 3;
  statistics.client_drops = 5;
  return statistics;
}

void print_states(Bytes& message) {
  encode_calibration_state(support::calibration_state(kTime), "suit", message);
  print(calibration_state_type(), message);
  encode_statistics(statistics(), "suit", message);
  print(statistics_type(), message);
  encode_diagnostics(
      std::vector<Diagnosis>{{Diagnosis::Level::error, "chest", "gone", "skin", {{"row 3", "silent_row"}}}}, kTime,
      "suit", message);
  print(diagnostics_type(), message);
  encode_classification(std::vector<Hypothesis>{{"unknown", 1.0}, {"tap", 0.625}}, kTime, "suit", message);
  print(classification_type(), message);
  encode_threat({kTime, "throat", "suit", "neck", "contact_force", Threat::State::latched, true, kTime, 25.5, 0.25,
                 30.5, 20.0, "N", 0.01, 0.02},
                message);
  print(threat_type(), message);
}

}  // namespace
}  // namespace dermis::bytes::ros_messages

int main() {
  dermis::bytes::ros_messages::Bytes message;
  dermis::bytes::ros_messages::print_frames(message);
  dermis::bytes::ros_messages::print_contacts(message);
  dermis::bytes::ros_messages::print_states(message);
  return 0;
}
