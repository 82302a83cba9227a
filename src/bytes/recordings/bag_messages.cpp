// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/recordings/bag_messages.hpp"

#include <algorithm>
#include <utility>

#include "bytes/recordings/message_kind.hpp"
#include "dermis/bytes/ros_messages/ros_messages.hpp"
#include "dermis/bytes/ros_messages/touch_messages.hpp"

namespace dermis::bytes::recordings {
namespace {

constexpr std::string_view kJson = "json";
constexpr std::string_view kText = "std_msgs/msg/String";

const ros_messages::TouchType* touch_type_of(const McapChannel& channel) {
  const std::vector<ros_messages::TouchType>& types = ros_messages::touch_types();
  const auto found = std::ranges::find(types, channel.schema_name, &ros_messages::TouchType::name);
  return found == types.end() ? nullptr : &*found;
}

Status read_image(const McapChannel& channel, std::span<const std::uint8_t> message,
                  std::vector<BagReading>& readings) {
  readings.resize(1);
  const Result<FrameShape> shape = decode_counts(channel, message, readings.front().frame);
  if (!shape) return shape.error();
  readings.front().shape = *shape;
  return Done{};
}

Status read_touch(const ros_messages::TouchType& type, std::span<const std::uint8_t> message,
                  std::vector<BagReading>& readings) {
  std::vector<ros_messages::TouchReading> decoded(type.arrays.size());
  if (Status done = type.decode(message, decoded); !done) return done;
  readings.clear();
  for (std::size_t k = 0; k < decoded.size(); ++k) {
    if (decoded[k].shape == FrameShape{}) continue;
    readings.push_back({type.arrays[k].name, decoded[k].shape, std::move(decoded[k].frame), type.is_raw_frame});
  }
  return Done{};
}

Status read_json(std::string_view text, std::vector<BagReading>& readings) {
  readings = readings_of_json(text);
  if (!readings.empty()) return Done{};
  return bad_input("the text holds no list of numbers in JSON");
}

Status read_text(std::span<const std::uint8_t> message, std::vector<BagReading>& readings) {
  const Result<std::string_view> text = ros_messages::decode_text(message);
  if (!text) return text.error();
  return read_json(*text, readings);
}

}  // namespace

bool may_be_readings(const McapChannel& channel) {
  if (channel.encoding == kJson) return true;
  if (channel.encoding != "cdr") return false;
  const MessageKind kind = kind_of(channel);
  if (kind != MessageKind::none) return kind == MessageKind::image;
  return channel.schema_name == kText || touch_type_of(channel) != nullptr;
}

Status read_readings(const McapChannel& channel, std::span<const std::uint8_t> message,
                     std::vector<BagReading>& readings) {
  if (channel.encoding == kJson)
    return read_json({reinterpret_cast<const char*>(message.data()), message.size()}, readings);
  if (kind_of(channel) == MessageKind::image) return read_image(channel, message, readings);
  if (channel.schema_name == kText) return read_text(message, readings);
  const ros_messages::TouchType* const type = touch_type_of(channel);
  if (type != nullptr) return read_touch(*type, message, readings);
  return bad_input("messages of " + channel.schema_name + " cannot be read");
}

}  // namespace dermis::bytes::recordings
