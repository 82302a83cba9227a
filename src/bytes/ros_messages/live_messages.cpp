// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/ros_messages/live_messages.hpp"

#include <algorithm>
#include <array>
#include <cstring>

#include "bytes/ros_messages/cdr.hpp"
#include "bytes/ros_messages/grid.hpp"
#include "bytes/ros_messages/header.hpp"
#include "bytes/ros_messages/point_field.hpp"

namespace dermis::bytes::ros_messages {
namespace {

constexpr std::array<GridField, 3> kConductanceFields{GridField{"siemens", 0, PackedElementType::float32},
                                                      {"sigma_siemens", kSigmaOffset, PackedElementType::float32},
                                                      {"status", kCellStatusOffset, PackedElementType::uint8}};

// A point is padded to a multiple of its floats.
constexpr std::size_t kPointStatusOffset = 16;
constexpr std::size_t kPointBytes = 20;
constexpr std::array<PointField, 5> kPointFields{PointField{"x", 0, PointFieldType::float32},
                                                 {"y", 4, PointFieldType::float32},
                                                 {"z", 8, PointFieldType::float32},
                                                 {"newtons", 12, PointFieldType::float32},
                                                 {"status", kPointStatusOffset, PointFieldType::uint8}};

void write_bool(CdrWriter& writer, bool value) {
  writer.write(static_cast<std::uint8_t>(value ? 1 : 0));
}

void write_count(CdrWriter& writer, std::size_t count) {
  writer.write(static_cast<std::uint32_t>(count));
}

/// geometry_msgs/Point and Vector3.
void write_vector(CdrWriter& writer, const Vector3& vector) {
  writer.write(vector.x);
  writer.write(vector.y);
  writer.write(vector.z);
}

void write_contact(CdrWriter& writer, const SuitContact& placed) {
  const Contact& contact = placed.contact;
  writer.write(contact.id);
  writer.write(static_cast<std::uint8_t>(contact.phase));
  write_stamp(writer, contact.onset);
  for (const double value : {contact.position.x, contact.position.y, contact.sigma_position_m.x,
                             contact.sigma_position_m.y, contact.velocity.x, contact.velocity.y, contact.force_n,
                             contact.sigma_force_n, contact.area_m2, contact.peak_pressure_pa, contact.mean_pressure_pa,
                             contact.major_axis_m, contact.minor_axis_m, contact.angle_rad}) {
    writer.write(value);
  }
  writer.write(contact.taxels);
  write_vector(writer, placed.place.position);
  write_vector(writer, placed.place.normal);
  write_vector(writer, placed.velocity);
}

void write_taxel(CdrWriter& writer, std::optional<std::uint32_t> taxel) {
  writer.write(taxel.value_or(std::numeric_limits<std::uint32_t>::max()));
}

void write_array_statistics(CdrWriter& writer, const ArrayStatistics& array) {
  writer.write_text(array.name);
  write_bool(writer, array.ended);
  writer.write_text(array.error);
  for (const std::uint64_t count : {array.frames, array.rejected, array.lost, array.damaged}) writer.write(count);
  for (const double value : {array.rate_hz, array.jitter_s, array.latency_p50_s, array.latency_p99_s,
                             array.temperature_celsius, array.supply_v}) {
    writer.write(value);
  }
  writer.write(array.skipped);
}

}  // namespace

void encode_conductance_grid(const ConductanceFrame& frame, const FrameShape& shape, const Pitch& pitch,
                             std::string_view frame_id, std::vector<std::uint8_t>& message) {
  write_taxels({frame.time, shape, pitch, frame_id}, kConductanceFields, frame.siemens, frame.sigma_siemens,
               frame.taxels, message);
}

void encode_points(std::span<const TaxelPoint> points, Nanos time, std::string_view frame_id,
                   std::vector<std::uint8_t>& message) {
  CdrWriter writer(message);
  write_header(writer, time, frame_id);
  write_count(writer, 1);
  write_count(writer, points.size());
  write_count(writer, kPointFields.size());
  for (const PointField& field : kPointFields) {
    writer.write_text(field.name);
    writer.write(field.offset);
    writer.write(static_cast<std::uint8_t>(field.type));
    write_count(writer, 1);
  }
  write_bool(writer, false);  // little-endian
  write_count(writer, kPointBytes);
  write_count(writer, kPointBytes * points.size());
  std::uint8_t* place = writer.write_bytes(kPointBytes * points.size()).data();
  for (const TaxelPoint& point : points) {
    const std::array<float, 4> values{point.x, point.y, point.z, point.newtons};
    std::memcpy(place, values.data(), sizeof(values));
    place[kPointStatusOffset] = static_cast<std::uint8_t>(point.status);
    place += kPointBytes;
  }
  write_bool(writer, false);  // forces may be NaN
}

void encode_contacts(const ArrayContacts& contacts, std::string_view frame_id, std::vector<std::uint8_t>& message) {
  CdrWriter writer(message);
  write_header(writer, contacts.report.time, frame_id);
  writer.write_text(contacts.array);
  writer.write(contacts.report.total_force_n);
  writer.write(contacts.report.sigma_total_n);
  write_bool(writer, contacts.centre_of_pressure.has_value());
  write_vector(writer, contacts.centre_of_pressure.value_or(Vector3{}));
  write_count(writer, contacts.contacts.size());
  for (const SuitContact& contact : contacts.contacts) write_contact(writer, contact);
  writer.write(contacts.sum.newtons);
  writer.write(contacts.sum.sigma_newtons);
}

void encode_statistics(const Statistics& statistics, std::string_view frame_id, std::vector<std::uint8_t>& message) {
  CdrWriter writer(message);
  write_header(writer, statistics.time, frame_id);
  write_count(writer, statistics.arrays.size());
  for (const ArrayStatistics& array : statistics.arrays) write_array_statistics(writer, array);
  write_bool(writer, statistics.recording);
  writer.write_text(statistics.recording_file);
  writer.write(statistics.recording_frames);
  writer.write(statistics.clients);
  writer.write(statistics.client_drops);
  writer.write(statistics.recording_left_out);
  writer.write(statistics.frames_not_streamed);
}

void encode_calibration_state(const CalibrationState& state, std::string_view frame_id,
                              std::vector<std::uint8_t>& message) {
  CdrWriter writer(message);
  write_header(writer, state.time, frame_id);
  writer.write_text(state.array);
  writer.write(static_cast<std::uint8_t>(state.stage));
  writer.write_text(state.message);
  writer.write(state.taxel);
  for (const double value : {state.weight_n, state.reading, state.hold_share}) writer.write(value);
  writer.write(state.presses_done);
  writer.write(state.presses_total);
  writer.write(state.median_relative_error);
  const std::span<std::uint8_t> presses = writer.write_bytes(state.taxel_presses.size());
  std::copy(state.taxel_presses.begin(), state.taxel_presses.end(), presses.begin());
  writer.write(static_cast<std::uint8_t>(state.hint));
  write_taxel(writer, state.pressed_taxel);
  writer.write(state.unpressed_relative_error);
  write_taxel(writer, state.together_with);
  writer.write(state.together_reading);
  write_taxel(writer, state.missing_taxel);
}

void encode_diagnostics(std::span<const Diagnosis> diagnoses, Nanos time, std::string_view frame_id,
                        std::vector<std::uint8_t>& message) {
  CdrWriter writer(message);
  write_header(writer, time, frame_id);
  write_count(writer, diagnoses.size());
  for (const Diagnosis& diagnosis : diagnoses) {
    writer.write(static_cast<std::uint8_t>(diagnosis.level));
    writer.write_text(diagnosis.name);
    writer.write_text(diagnosis.message);
    writer.write_text(diagnosis.hardware_id);
    write_count(writer, diagnosis.values.size());
    for (const auto& [key, value] : diagnosis.values) {
      writer.write_text(key);
      writer.write_text(value);
    }
  }
}

void encode_transforms(std::span<const Transform> transforms, Nanos time, std::vector<std::uint8_t>& message) {
  CdrWriter writer(message);
  write_count(writer, transforms.size());
  for (const Transform& transform : transforms) {
    write_header(writer, time, transform.parent);
    writer.write_text(transform.child);
    write_vector(writer, transform.parent_from_child.translation);
    const Quaternion& turn = transform.parent_from_child.rotation;
    for (const double value : {turn.x, turn.y, turn.z, turn.w}) writer.write(value);
  }
}

void encode_classification(std::span<const Hypothesis> results, Nanos time, std::string_view frame_id,
                           std::vector<std::uint8_t>& message) {
  CdrWriter writer(message);
  write_header(writer, time, frame_id);
  write_count(writer, results.size());
  for (const Hypothesis& result : results) {
    writer.write_text(result.class_id);
    writer.write(result.score);
  }
}

void encode_threat(const Threat& threat, std::vector<std::uint8_t>& message) {
  CdrWriter writer(message);
  write_header(writer, threat.time, threat.array);
  for (const std::string_view text : {threat.name, threat.array, threat.zone, threat.quantity}) writer.write_text(text);
  writer.write(static_cast<std::uint8_t>(threat.state));
  write_bool(writer, threat.changed);
  write_stamp(writer, threat.crossed);
  for (const double value : {threat.value, threat.sigma, threat.worst, threat.limit}) writer.write(value);
  writer.write_text(threat.unit);
  writer.write(threat.x);
  writer.write(threat.y);
}

void encode_wrench(const Wrench& wrench, Nanos time, std::string_view frame_id, std::vector<std::uint8_t>& message) {
  CdrWriter writer(message);
  write_header(writer, time, frame_id);
  write_vector(writer, wrench.force);
  write_vector(writer, wrench.torque);
}

}  // namespace dermis::bytes::ros_messages
