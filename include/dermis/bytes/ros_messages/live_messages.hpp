// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "dermis/bytes/bodies/surface.hpp"
#include "dermis/bytes/bodies/wrench.hpp"
#include "dermis/bytes/ros_messages/ros_messages.hpp"
#include "dermis/touch/frames/contacts.hpp"
#include "dermis/touch/frames/frames.hpp"

/// Live results of frames as ROS 2 messages in CDR (docs/stream.md). encode_...() replace the content of `message`, and
/// allocate nothing once it has its size.
namespace dermis::bytes::ros_messages {

[[nodiscard]] const MessageType& point_cloud_type();
[[nodiscard]] const MessageType& contacts_type();
[[nodiscard]] const MessageType& statistics_type();
[[nodiscard]] const MessageType& calibration_state_type();
[[nodiscard]] const MessageType& diagnostics_type();
[[nodiscard]] const MessageType& transforms_type();
[[nodiscard]] const MessageType& classification_type();
[[nodiscard]] const MessageType& threat_type();
[[nodiscard]] const MessageType& wrench_type();

/// foxglove_msgs/msg/Grid with the fields siemens and sigma_siemens (float32) and status (uint8, TaxelStatus) of each
/// taxel, placed as encode_grid() places forces.
void encode_conductance_grid(const ConductanceFrame& frame, const FrameShape& shape, const Pitch& pitch,
                             std::string_view frame_id, std::vector<std::uint8_t>& message);

/// A taxel of a suit.
struct TaxelPoint {
  float x = 0.0F;  ///< [m]
  float y = 0.0F;
  float z = 0.0F;
  float newtons = std::numeric_limits<float>::quiet_NaN();
  TaxelStatus status = TaxelStatus::invalid;
};

/// sensor_msgs/msg/PointCloud2 with the fields x, y, z, newtons (float32) and status (uint8), 20 bytes a point.
void encode_points(std::span<const TaxelPoint> points, Nanos time, std::string_view frame_id,
                   std::vector<std::uint8_t>& message);

/// dermis_msgs/msg/Contacts: the contacts of one array in one frame.
struct ArrayContacts {
  std::string_view array;
  const ContactReport& report;
  std::span<const SuitContact> contacts;        ///< Those of the report, placed.
  std::optional<Vector3> centre_of_pressure{};  ///< In the suit's frame.
  TotalForce sum{};                             ///< On the whole array.
};
void encode_contacts(const ArrayContacts& contacts, std::string_view frame_id, std::vector<std::uint8_t>& message);

/// dermis_msgs/msg/Statistics.
struct ArrayStatistics {
  std::string name;
  bool ended = false;
  std::string error;
  std::uint64_t frames = 0;
  std::uint64_t rejected = 0;
  std::uint64_t lost = 0;
  std::uint64_t damaged = 0;
  double rate_hz = 0.0;
  double jitter_s = 0.0;
  double latency_p50_s = 0.0;
  double latency_p99_s = 0.0;
  double temperature_celsius = std::numeric_limits<double>::quiet_NaN();  ///< NaN: not known.
  double supply_v = std::numeric_limits<double>::quiet_NaN();             ///< NaN: not known.
  std::uint64_t skipped = 0;
};
struct Statistics {
  Nanos time{};
  std::vector<ArrayStatistics> arrays;
  bool recording = false;
  std::string recording_file;
  std::uint64_t recording_frames = 0;
  std::uint32_t clients = 0;
  std::uint64_t client_drops = 0;
  std::uint64_t recording_left_out = 0;
  std::uint64_t frames_not_streamed = 0;
};
void encode_statistics(const Statistics& statistics, std::string_view frame_id, std::vector<std::uint8_t>& message);

/// dermis_msgs/msg/CalibrationState. Many members: the fields of the message.
struct CalibrationState {
  enum class Stage : std::uint8_t { none, unloaded, pressing, fitting, done, failed };
  enum class Hint : std::uint8_t { none, press, hold, release, other_taxel, unsteady, too_short, several, one_of_two };
  Nanos time{};
  std::string array;
  Stage stage = Stage::none;
  std::string message;
  std::uint32_t taxel = 0;
  double weight_n = 0.0;
  double reading = 1.0;
  double hold_share = 0.0;
  std::uint32_t presses_done = 0;
  std::uint32_t presses_total = 0;
  double median_relative_error = std::numeric_limits<double>::quiet_NaN();
  std::vector<std::uint8_t> taxel_presses;
  Hint hint = Hint::none;
  std::optional<std::uint32_t> pressed_taxel{};
  double unpressed_relative_error = std::numeric_limits<double>::quiet_NaN();
  std::optional<std::uint32_t> together_with{};
  double together_reading = std::numeric_limits<double>::quiet_NaN();
  std::optional<std::uint32_t> missing_taxel{};
};
void encode_calibration_state(const CalibrationState& state, std::string_view frame_id,
                              std::vector<std::uint8_t>& message);

/// diagnostic_msgs/msg/DiagnosticArray.
struct Diagnosis {
  enum class Level : std::uint8_t { ok, warning, error, stale };
  Level level = Level::ok;
  std::string name;
  std::string message;
  std::string hardware_id;
  std::vector<std::pair<std::string, std::string>> values;
};
void encode_diagnostics(std::span<const Diagnosis> diagnoses, Nanos time, std::string_view frame_id,
                        std::vector<std::uint8_t>& message);

/// tf2_msgs/msg/TFMessage.
struct Transform {
  std::string parent;
  std::string child;
  Pose parent_from_child;
};
void encode_transforms(std::span<const Transform> transforms, Nanos time, std::vector<std::uint8_t>& message);

/// vision_msgs/msg/Classification: what touches an array, the answer first.
struct Hypothesis {
  std::string_view class_id;
  double score = 0.0;
};
void encode_classification(std::span<const Hypothesis> results, Nanos time, std::string_view frame_id,
                           std::vector<std::uint8_t>& message);

/// dermis_msgs/msg/Threat: the state of one limit in one array.
struct Threat {
  enum class State : std::uint8_t { clear, crossed, active, latched };
  Nanos time{};
  std::string_view name;
  std::string_view array;
  std::string_view zone;
  std::string_view quantity;
  State state = State::clear;
  bool changed = false;
  Nanos crossed{};
  double value = 0.0;
  double sigma = 0.0;
  double worst = 0.0;
  double limit = 0.0;
  std::string_view unit;
  double x = 0.0;
  double y = 0.0;
};
void encode_threat(const Threat& threat, std::vector<std::uint8_t>& message);

/// geometry_msgs/msg/WrenchStamped.
void encode_wrench(const Wrench& wrench, Nanos time, std::string_view frame_id, std::vector<std::uint8_t>& message);

}  // namespace dermis::bytes::ros_messages
