// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/ros_messages/ros_messages.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstring>

#include "bytes/ros_messages/cdr.hpp"
#include "bytes/ros_messages/count_words.hpp"
#include "bytes/ros_messages/grid.hpp"
#include "bytes/ros_messages/header.hpp"
#include "dermis/touch/frames/array_description.hpp"

namespace dermis::bytes::ros_messages {
namespace {

Nanos read_stamp(CdrReader& reader) {
  const auto seconds = reader.read<std::int32_t>();
  const auto nanos = reader.read<std::uint32_t>();
  return Nanos(seconds * kNanosPerSecond + nanos);
}

Nanos read_header(CdrReader& reader) {
  const Nanos stamp = read_stamp(reader);
  static_cast<void>(reader.read_text());
  return stamp;
}

Error not_whole(const char* type) {
  return bad_input(std::string("the message is no whole ") + type + " in CDR");
}

Error not_whole(const MessageType& type) {
  return not_whole(type.name);
}

/// The fields of an image before its data, and the place of the data.
std::span<std::uint8_t> write_image(Nanos time, const FrameShape& shape, std::string_view frame_id,
                                    const char* encoding, std::size_t taxel_bytes, std::vector<std::uint8_t>& message) {
  CdrWriter writer(message);
  write_header(writer, time, frame_id);
  writer.write(static_cast<std::uint32_t>(shape.rows));
  writer.write(static_cast<std::uint32_t>(shape.cols));
  writer.write_text(encoding);
  writer.write(std::uint8_t{0});
  writer.write(static_cast<std::uint32_t>(shape.cols * taxel_bytes));
  return writer.write_bytes(shape.taxel_count() * taxel_bytes);
}

template <typename T>
void read_numbers(std::span<const std::uint8_t> row, bool big_endian, std::span<float> counts) {
  for (std::size_t i = 0; i < counts.size(); ++i) {
    std::array<std::uint8_t, sizeof(T)> bytes{};
    std::copy_n(row.data() + i * sizeof(T), sizeof(T), bytes.data());
    if (big_endian) std::reverse(bytes.begin(), bytes.end());
    counts[i] = static_cast<float>(std::bit_cast<T>(bytes));
  }
}

void read_words(std::span<const std::uint8_t> row, bool big_endian, std::span<float> counts) {
  if (!big_endian) return uint16_to_counts(row.data(), counts.size(), counts.data());
  read_numbers<std::uint16_t>(row, big_endian, counts);
}

/// How the pixels of an image stand in its bytes.
struct PixelType {
  std::string_view encoding;
  std::size_t bytes;
  void (*read)(std::span<const std::uint8_t> row, bool big_endian, std::span<float> counts);
};
constexpr std::array<PixelType, 9> kPixelTypes{{{"16UC1", 2, read_words},
                                                {"mono16", 2, read_words},
                                                {"32FC1", 4, read_numbers<float>},
                                                {"mono8", 1, read_numbers<std::uint8_t>},
                                                {"8UC1", 1, read_numbers<std::uint8_t>},
                                                {"8SC1", 1, read_numbers<std::int8_t>},
                                                {"16SC1", 2, read_numbers<std::int16_t>},
                                                {"32SC1", 4, read_numbers<std::int32_t>},
                                                {"64FC1", 8, read_numbers<double>}}};

constexpr std::array<GridField, 3> kGridFields{GridField{"newtons", 0, PackedElementType::float32},
                                               {"sigma_newtons", kSigmaOffset, PackedElementType::float32},
                                               {"status", kCellStatusOffset, PackedElementType::uint8}};

bool is_possible(std::size_t rows, std::size_t cols) {
  return rows >= 1 && rows <= kMaxLines && cols >= 1 && cols <= kMaxLines;
}

/// As many as an array may have: some, or one on each taxel (ArrayDescription::temperature_sensors).
bool is_possible_sensors(std::size_t sensors, std::size_t taxels) {
  return sensors <= kMaxPlacedSensors || sensors == taxels;
}

template <typename T>
void write_optional(CdrWriter& writer, const std::optional<T>& value) {
  writer.write(static_cast<std::uint8_t>(value ? 1 : 0));
  writer.write(value.value_or(T{}));
}

template <typename T>
std::optional<T> read_optional(CdrReader& reader) {
  const bool has_value = reader.read<std::uint8_t>() != 0;
  const T value = reader.read<T>();
  return has_value ? std::optional<T>(value) : std::nullopt;
}

Nanos read_nanos(CdrReader& reader) {
  return Nanos(reader.read<std::int64_t>());
}

void write_acquisition(CdrWriter& writer, const RawFrame& frame) {
  const Acquisition& acquisition = frame.acquisition;
  writer.write(frame.time.count());
  write_optional(writer, acquisition.sequence);
  writer.write(static_cast<std::uint8_t>(acquisition.device_time ? 1 : 0));
  writer.write(acquisition.device_time.value_or(Nanos{}).count());
  writer.write(acquisition.arrival_steady.count());
  writer.write(acquisition.arrival_utc.count());
  writer.write(acquisition.lost_before);
  writer.write(acquisition.held_taxels);
  write_optional(writer, frame.supply_v);
}

void read_acquisition(CdrReader& reader, RawFrame& frame) {
  Acquisition& acquisition = frame.acquisition;
  frame.time = read_nanos(reader);
  acquisition.sequence = read_optional<std::uint64_t>(reader);
  const std::optional<std::int64_t> device_time = read_optional<std::int64_t>(reader);
  acquisition.device_time = device_time ? std::optional<Nanos>(*device_time) : std::nullopt;
  acquisition.arrival_steady = read_nanos(reader);
  acquisition.arrival_utc = read_nanos(reader);
  acquisition.lost_before = reader.read<std::uint32_t>();
  acquisition.held_taxels = reader.read<std::uint32_t>();
  frame.supply_v = read_optional<double>(reader);
}

}  // namespace

void encode_image(const RawFrame& frame, const FrameShape& shape, std::string_view frame_id,
                  std::vector<std::uint8_t>& message) {
  assert(frame.counts.size() == shape.taxel_count());
  const std::span<std::uint8_t> words = write_image(frame.time, shape, frame_id, "16UC1", 2, message);
  if (counts_to_uint16(frame.counts.data(), frame.counts.size(), words.data())) return;
  encode_value_image(frame.counts, frame.time, shape, frame_id, message);
}

void encode_value_image(std::span<const float> values, Nanos time, const FrameShape& shape, std::string_view frame_id,
                        std::vector<std::uint8_t>& message) {
  assert(values.size() == shape.taxel_count());
  const std::span<std::uint8_t> floats = write_image(time, shape, frame_id, "32FC1", 4, message);
  std::memcpy(floats.data(), values.data(), floats.size());
}

Result<FrameShape> decode_image(std::span<const std::uint8_t> message, RawFrame& frame) {
  CdrReader reader(message);
  frame.time = read_header(reader);
  const std::size_t rows = reader.read<std::uint32_t>();
  const std::size_t cols = reader.read<std::uint32_t>();
  const std::string_view encoding = reader.read_text();
  const bool big_endian = reader.read<std::uint8_t>() != 0;
  const std::size_t step = reader.read<std::uint32_t>();
  const std::span<const std::uint8_t> data = reader.read_bytes();
  if (!reader.good()) return not_whole(image_type());
  const auto* const pixel = std::ranges::find(kPixelTypes, encoding, &PixelType::encoding);
  if (pixel == kPixelTypes.end()) {
    return bad_input("the image is " + std::string(encoding.substr(0, 20)) +
                     "; mono8, mono16, 32FC1 and others of one channel can be read");
  }
  if (!is_possible(rows, cols)) {
    return bad_input("the image has " + std::to_string(rows) + "x" + std::to_string(cols) +
                     " pixels; 1x1 to 1024x1024 can be read");
  }
  const std::size_t row_bytes = cols * pixel->bytes;
  if (step < row_bytes || data.size() / step < rows) return bad_input("the image is shorter than its size says");
  frame.counts.resize(rows * cols);
  for (std::size_t row = 0; row < rows; ++row) {
    const std::span<float> counts = std::span<float>(frame.counts).subspan(row * cols, cols);
    const std::span<const std::uint8_t> bytes = data.subspan(row * step, row_bytes);
    pixel->read(bytes, big_endian, counts);
  }
  return FrameShape{rows, cols};
}

Result<std::string_view> decode_text(std::span<const std::uint8_t> message) {
  CdrReader reader(message);
  const std::string_view text = reader.read_text();
  if (!reader.good()) return not_whole("std_msgs/msg/String");
  return text;
}

void encode_mark(const Mark& mark, std::string_view frame_id, std::vector<std::uint8_t>& message) {
  CdrWriter writer(message);
  write_header(writer, mark.time, frame_id);
  for (const std::string* text : {&mark.label, &mark.by, &mark.event}) writer.write_text(*text);
}

Result<Mark> decode_mark(std::span<const std::uint8_t> message) {
  CdrReader reader(message);
  Mark mark{.time = read_header(reader)};
  for (std::string* text : {&mark.label, &mark.by, &mark.event}) *text = reader.read_text();
  if (!reader.good()) return not_whole(mark_type());
  return mark;
}

Result<FrameShape> decode_tactile_state(std::span<const std::uint8_t> message, RawFrame& frame) {
  CdrReader reader(message);
  frame.time = read_header(reader);
  frame.counts.clear();
  const std::size_t sensors = reader.read<std::uint32_t>();
  std::size_t each = 0;
  bool is_table = true;
  for (std::size_t sensor = 0; sensor < sensors && reader.good(); ++sensor) {
    static_cast<void>(reader.read_text());  // its name
    const std::size_t values = reader.read<std::uint32_t>();
    if (sensor == 0) each = values;
    is_table = is_table && values == each;
    for (std::size_t k = 0; k < values && reader.good(); ++k) frame.counts.push_back(reader.read<float>());
  }
  if (!reader.good()) return not_whole(kTactileState);
  const FrameShape shape = is_table ? FrameShape{sensors, each} : FrameShape{1, frame.counts.size()};
  if (is_possible(shape.rows, shape.cols)) return shape;
  return bad_input("the sensors have " + std::to_string(shape.rows) + "x" + std::to_string(shape.cols) +
                   " values; 1x1 to 1024x1024 can be read");
}

Status decode_joint_state(std::span<const std::uint8_t> message, JointNumbers& joints) {
  constexpr int kQuantities = 3;  // position, velocity, effort
  CdrReader reader(message);
  static_cast<void>(read_header(reader));
  joints.names.clear();
  joints.numbers.clear();
  const std::size_t names = reader.read<std::uint32_t>();
  for (std::size_t k = 0; k < names && reader.good(); ++k) joints.names.emplace_back(reader.read_text());
  for (int quantity = 0; quantity < kQuantities; ++quantity) {
    const std::size_t count = reader.read<std::uint32_t>();
    const bool is_taken = joints.numbers.empty();
    for (std::size_t k = 0; k < count && reader.good(); ++k) {
      const auto number = reader.read<double>();
      if (is_taken) joints.numbers.push_back(number);
    }
  }
  if (!reader.good()) return not_whole(kJointState);
  if (joints.numbers.empty()) joints.names.clear();
  if (joints.numbers.size() == joints.names.size()) return Done{};
  return bad_input("the message names " + std::to_string(joints.names.size()) + " joints and has numbers of " +
                   std::to_string(joints.numbers.size()));
}

void encode_temperature(double celsius, Nanos time, std::string_view frame_id, std::vector<std::uint8_t>& message) {
  CdrWriter writer(message);
  write_header(writer, time, frame_id);
  writer.write(celsius);
  writer.write(0.0);
}

Result<double> decode_temperature(std::span<const std::uint8_t> message) {
  CdrReader reader(message);
  static_cast<void>(read_header(reader));
  const auto celsius = reader.read<double>();
  static_cast<void>(reader.read<double>());
  if (!reader.good()) return not_whole(temperature_type());
  return celsius;
}

void encode_acquisition(const RawFrame& frame, std::vector<std::uint8_t>& message) {
  CdrWriter writer(message);
  write_acquisition(writer, frame);
}

Status decode_acquisition(std::span<const std::uint8_t> message, RawFrame& frame) {
  CdrReader reader(message);
  read_acquisition(reader, frame);
  if (!reader.good()) return not_whole(acquisition_type());
  return Done{};
}

void encode_raw_frame(const RawFrame& frame, const FrameShape& shape, std::string_view frame_id,
                      std::vector<std::uint8_t>& message) {
  assert(frame.counts.size() == shape.taxel_count());
  CdrWriter writer(message);
  write_header(writer, frame.time, frame_id);
  write_acquisition(writer, frame);
  write_optional(writer, frame.temperature_celsius);
  writer.write_floats(frame.sensor_celsius);
  writer.write(static_cast<std::uint32_t>(shape.rows));
  writer.write(static_cast<std::uint32_t>(shape.cols));
  writer.write_floats(frame.counts);
}

Result<FrameShape> decode_raw_frame(std::span<const std::uint8_t> message, RawFrame& frame) {
  CdrReader reader(message);
  static_cast<void>(read_header(reader));
  read_acquisition(reader, frame);
  frame.temperature_celsius = read_optional<double>(reader);
  reader.read_floats(frame.sensor_celsius);
  const std::size_t rows = reader.read<std::uint32_t>();
  const std::size_t cols = reader.read<std::uint32_t>();
  reader.read_floats(frame.counts);
  if (!reader.good()) return not_whole(raw_frame_type());
  if (is_possible(rows, cols) && frame.counts.size() == rows * cols) {
    if (is_possible_sensors(frame.sensor_celsius.size(), frame.counts.size())) return FrameShape{rows, cols};
    return bad_input("the message has " + std::to_string(frame.sensor_celsius.size()) +
                     " temperatures; 64 of an array, or one of each taxel, can be read");
  }
  return bad_input("the message has " + std::to_string(frame.counts.size()) + " counts of " + std::to_string(rows) +
                   "x" + std::to_string(cols) + " taxels; all of 1x1 to 1024x1024 can be read");
}

void encode_grid(const ForceFrame& frame, const FrameShape& shape, const Pitch& pitch, std::string_view frame_id,
                 std::vector<std::uint8_t>& message) {
  write_taxels({frame.time, shape, pitch, frame_id}, kGridFields, frame.newtons, frame.sigma_newtons, frame.taxels,
               message);
}

Result<FrameShape> decode_grid(std::span<const std::uint8_t> message, ForceFrame& frame) {
  constexpr int kNumbersOfPose = 7;
  CdrReader reader(message);
  frame.time = read_header(reader);
  for (int k = 0; k < kNumbersOfPose; ++k) static_cast<void>(reader.read<double>());
  const std::size_t cols = reader.read<std::uint32_t>();
  for (int k = 0; k < 2; ++k) static_cast<void>(reader.read<double>());  // pitches
  const std::size_t row_bytes = reader.read<std::uint32_t>();
  const std::size_t cell_bytes = reader.read<std::uint32_t>();
  bool has_fields = reader.read<std::uint32_t>() == kGridFields.size();
  for (const GridField& field : kGridFields) {
    if (!has_fields) break;
    has_fields = reader.read_text() == field.name && reader.read<std::uint32_t>() == field.offset;
    has_fields = reader.read<std::uint8_t>() == static_cast<std::uint8_t>(field.type) && has_fields;
  }
  const std::span<const std::uint8_t> cells = reader.read_bytes();
  const bool is_ours = reader.good() && has_fields && cell_bytes == kCellBytes && cols >= 1 && cols <= kMaxLines &&
                       row_bytes == cols * cell_bytes && !cells.empty() && cells.size() % row_bytes == 0 &&
                       cells.size() / row_bytes <= kMaxLines;
  if (!is_ours) return not_whole(grid_type());
  read_taxels(cells, frame.newtons, frame.sigma_newtons, frame.taxels);
  return FrameShape{cells.size() / row_bytes, cols};
}

void encode_frame_status(const ForceFrame& frame, std::vector<std::uint8_t>& message) {
  CdrWriter writer(message);
  writer.write(frame.time.count());
  writer.write(static_cast<std::uint16_t>(frame.status));
}

}  // namespace dermis::bytes::ros_messages
