// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/ros_messages/touch_messages.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <optional>
#include <set>
#include <span>
#include <type_traits>

#include "bytes/ros_messages/cdr.hpp"
#include "dermis/bytes/ros_messages/ros_messages.hpp"
#include "dermis/touch/frames/array_description.hpp"
#include "dermis/touch/frames/mean_celsius.hpp"
#include "dermis/touch/frames/nearest_name.hpp"

namespace dermis::bytes::ros_messages {
namespace {

using Message = std::span<const std::uint8_t>;

constexpr std::size_t kMostMotors = 64;
constexpr std::size_t kMostModules = 64;
constexpr std::size_t kMostDimensions = 16;
constexpr FrameShape kModule{3, 4};
constexpr std::size_t kModuleTaxels = 12;
constexpr float kAbsentPressure = 30000.0F;  // the hand sends it where it has no sensor
constexpr float kColdest = -40.0F;           // [C] what a sensor can measure
constexpr float kWarmest = 125.0F;
constexpr float kLargestExact = 16777216.0F;  // up to here a float holds every whole number

Error not_whole(const char* name) {
  return bad_input(std::string("the message is no whole ") + name + " in CDR");
}

template <typename T>
void skip(CdrReader& reader, std::size_t count = 1) {
  for (std::size_t k = 0; k < count; ++k) static_cast<void>(reader.read<T>());
}

/// mode, q, dq, ddq, tau_est, temperature[2], vol, sensor[2], motorstate and reserve[4].
void skip_motor(CdrReader& reader) {
  skip<std::uint8_t>(reader);
  skip<float>(reader, 4);
  skip<std::int16_t>(reader, 2);
  skip<float>(reader);
  skip<std::uint32_t>(reader, 7);
}

/// Beside each pressure is the temperature of its sensor, NaN where there is none. That of the module is their mean.
void read_module(CdrReader& reader, TouchReading& reading) {
  reading.shape = kModule;
  std::vector<float>& counts = reading.frame.counts;
  counts.resize(kModuleTaxels);
  for (float& count : counts) count = reader.read<float>();
  std::vector<float>& sensors = reading.frame.sensor_celsius;
  sensors.assign(kModuleTaxels, std::numeric_limits<float>::quiet_NaN());
  for (std::size_t k = 0; k < kModuleTaxels; ++k) {
    const auto celsius = reader.read<float>();
    if (counts[k] != kAbsentPressure && celsius >= kColdest && celsius <= kWarmest) sensors[k] = celsius;
  }
  reading.frame.temperature_celsius = mean_celsius(std::span<const float>(sensors));
  std::replace(counts.begin(), counts.end(), kAbsentPressure, std::numeric_limits<float>::quiet_NaN());
  skip<std::uint32_t>(reader, 2);  // lost, reserve
}

Status decode_hand_state(Message message, std::span<TouchReading> readings) {
  constexpr const char* kName = "unitree_hg/msg/HandState";
  CdrReader reader(message);
  const std::size_t motors = reader.read<std::uint32_t>();
  if (!reader.good() || motors > kMostMotors) return not_whole(kName);
  for (std::size_t k = 0; k < motors; ++k) skip_motor(reader);
  const std::size_t modules = reader.read<std::uint32_t>();
  if (!reader.good() || modules > kMostModules) return not_whole(kName);
  TouchReading unknown;
  for (TouchReading& reading : readings) reading.shape = {};
  for (std::size_t k = 0; k < modules; ++k) read_module(reader, k < readings.size() ? readings[k] : unknown);
  skip<float>(reader, 13);  // imu_state: quaternion, gyroscope, accelerometer, rpy
  skip<std::int16_t>(reader);
  skip<float>(reader, 4);          // power_v, power_a, system_v, device_v
  skip<std::uint32_t>(reader, 4);  // error, reserve
  if (!reader.good()) return not_whole(kName);
  return Done{};
}

std::vector<TouchArray> dex3_modules() {
  std::vector<TouchArray> modules;
  for (int k = 0; k < 9; ++k) modules.push_back({"module_" + std::to_string(k), kModule});
  return modules;
}

std::vector<TouchArray> inspire_regions() {
  std::vector<TouchArray> regions;
  for (const char* const finger : {"little", "ring", "middle", "index"}) {
    regions.push_back({std::string(finger) + "_tip", {3, 3}});
    regions.push_back({std::string(finger) + "_top", {12, 8}});
    regions.push_back({std::string(finger) + "_palm", {10, 8}});
  }
  regions.push_back({"thumb_tip", {3, 3}});
  regions.push_back({"thumb_top", {12, 8}});
  regions.push_back({"thumb_middle", {3, 3}});
  regions.push_back({"thumb_palm", {12, 8}});
  regions.push_back({"palm", {14, 8}});
  return regions;
}

Status decode_inspire_touch(Message message, std::span<TouchReading> readings) {
  static const std::vector<TouchArray> kRegions = inspire_regions();
  constexpr const char* kName = "inspire/inspire_hand_touch";
  CdrReader reader(message);
  for (std::size_t k = 0; k < kRegions.size(); ++k) {
    const std::size_t count = reader.read<std::uint32_t>();
    const std::size_t expected = kRegions[k].shape.taxel_count();
    if (!reader.good()) return not_whole(kName);
    if (count != expected) {
      return bad_input("the message has " + std::to_string(count) + " readings of " + kRegions[k].name + ", not " +
                       std::to_string(expected));
    }
    readings[k].shape = kRegions[k].shape;
    readings[k].frame.counts.resize(count);
    for (float& reading : readings[k].frame.counts) reading = reader.read<std::int16_t>();
  }
  if (!reader.good()) return not_whole(kName);
  return Done{};
}

Status decode_image_reading(Message message, std::span<TouchReading> readings) {
  TouchReading& reading = readings.front();
  const Result<FrameShape> shape = decode_image(message, reading.frame);
  if (!shape) return shape.error();
  reading.shape = *shape;
  reading.frame.acquisition.device_time = reading.frame.time;
  return Done{};
}

Status decode_frame_reading(Message message, std::span<TouchReading> readings) {
  const Result<FrameShape> shape = decode_raw_frame(message, readings.front().frame);
  if (!shape) return shape.error();
  readings.front().shape = *shape;
  return Done{};
}

/// The shape of two dimensions, or of those that are not 1. Values without dimensions are one row, of any length.
Result<FrameShape> shape_of(std::span<const std::size_t> sizes, std::size_t values) {
  FrameShape shape{1, values};
  std::vector<std::size_t> lines;
  std::copy_if(sizes.begin(), sizes.end(), std::back_inserter(lines), [](std::size_t size) { return size != 1; });
  if (lines.size() == 2) shape = {lines[0], lines[1]};
  if (sizes.size() == 2) shape = {sizes[0], sizes[1]};
  if (lines.size() > 2) return bad_input("the message has more than two dimensions");
  const bool is_possible = shape.rows >= 1 && shape.rows <= kMaxLines && shape.cols >= 1 &&
                           shape.cols <= (sizes.empty() ? kMaxLines * kMaxLines : kMaxLines);
  if (!is_possible || shape.taxel_count() != values) {
    return bad_input("the message has " + std::to_string(values) + " values, which its dimensions do not give");
  }
  return shape;
}

/// "std_msgs/msg/UInt16MultiArray"
template <typename T>
std::string multi_array_name() {
  const char* const kind = std::is_floating_point_v<T> ? "Float" : std::is_signed_v<T> ? "Int" : "UInt";
  return std::string("std_msgs/msg/") + kind + std::to_string(8 * sizeof(T)) + "MultiArray";
}

/// Sizes of the dimensions; empty where there are too many.
std::optional<std::vector<std::size_t>> read_dimensions(CdrReader& reader) {
  std::vector<std::size_t> sizes;
  const std::size_t dimensions = reader.read<std::uint32_t>();
  if (dimensions > kMostDimensions) return std::nullopt;
  for (std::size_t k = 0; k < dimensions && reader.good(); ++k) {
    static_cast<void>(reader.read_text());
    sizes.push_back(reader.read<std::uint32_t>());
    skip<std::uint32_t>(reader);  // stride
  }
  return sizes;
}

template <typename T>
Status decode_multi_array(Message message, std::span<TouchReading> readings) {
  CdrReader reader(message);
  const std::optional<std::vector<std::size_t>> sizes = read_dimensions(reader);
  const std::size_t offset = reader.read<std::uint32_t>();
  const std::size_t count = reader.read<std::uint32_t>();
  if (!sizes || !reader.good() || count > message.size() / sizeof(T)) return not_whole(multi_array_name<T>().c_str());
  if (offset > count) return bad_input("the message has a data_offset behind its values");
  readings.front().shape = {};
  if (offset == count) return Done{};  // some nodes begin with nothing
  skip<T>(reader, offset);
  const Result<FrameShape> shape = shape_of(*sizes, count - offset);
  if (!shape) return shape.error();
  readings.front().shape = *shape;
  std::vector<float>& counts = readings.front().frame.counts;
  counts.resize(shape->taxel_count());
  for (float& value : counts) {
    const T number = reader.read<T>();
    value = static_cast<float>(number);
    if (std::is_integral_v<T> && std::abs(value) > kLargestExact) {
      return bad_input("the message has a value beyond 16777216, which cannot be held exactly");
    }
  }
  if (!reader.good()) return not_whole(multi_array_name<T>().c_str());
  return Done{};
}

template <typename T>
TouchType multi_array() {
  const std::string name = multi_array_name<T>();
  const std::string in_dds = "std_msgs::msg::dds_::" + name.substr(name.rfind('/') + 1) + "_";
  return {name, in_dds, {TouchArray{}}, decode_multi_array<T>};
}

/// "unitree_hg/HandState" and "unitree_hg/msg/HandState" are the same.
std::string without_msg(std::string name) {
  if (const std::size_t at = name.find("/msg/"); at != std::string::npos) name.erase(at, 4);
  return name;
}

}  // namespace

const std::vector<TouchType>& touch_types() {
  static const std::vector<TouchType> kTypes = {
      {"unitree_hg/msg/HandState", "unitree_hg::msg::dds_::HandState_", dex3_modules(), decode_hand_state},
      {"inspire/inspire_hand_touch", "inspire::inspire_hand_touch", inspire_regions(), decode_inspire_touch},
      {"dermis_msgs/msg/RawFrame", "dermis_msgs::msg::dds_::RawFrame_", {TouchArray{}}, decode_frame_reading, true},
      {"sensor_msgs/msg/Image", "sensor_msgs::msg::dds_::Image_", {TouchArray{}}, decode_image_reading},
      multi_array<float>(),
      multi_array<double>(),
      multi_array<std::uint8_t>(),
      multi_array<std::int8_t>(),
      multi_array<std::uint16_t>(),
      multi_array<std::int16_t>(),
      multi_array<std::uint32_t>(),
      multi_array<std::int32_t>()};
  return kTypes;
}

Result<const TouchType*> find_touch_type(std::string_view name) {
  std::set<std::string> names;
  for (const TouchType& type : touch_types()) {
    if (without_msg(std::string(name)) == without_msg(type.name) || name == type.dds_name) return &type;
    names.insert(type.name);
  }
  const std::string nearest = nearest_name(std::string(name), names);
  if (!nearest.empty()) return bad_input("type=" + std::string(name) + ": did you mean '" + nearest + "'?");
  std::string known;
  for (const std::string& one : names) known += (known.empty() ? "" : ", ") + one;
  return bad_input("type=" + std::string(name) + ": is not known; known are " + known);
}

}  // namespace dermis::bytes::ros_messages
