// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/recordings/message_kind.hpp"

#include "dermis/bytes/ros_messages/live_messages.hpp"
#include "dermis/bytes/ros_messages/ros_messages.hpp"

namespace dermis::bytes::recordings {

MessageKind kind_of(const McapChannel& channel) {
  if (channel.encoding != "cdr") return MessageKind::none;
  if (is_tactile_state(channel)) return MessageKind::image;
  if (channel.schema_name == ros_messages::image_type().name) {
    return channel.topic.ends_with(std::string("/") + kSensorsTopic) ? MessageKind::sensors : MessageKind::image;
  }
  if (channel.schema_name == ros_messages::acquisition_type().name) return MessageKind::acquisition;
  if (channel.schema_name == ros_messages::temperature_type().name) return MessageKind::temperature;
  if (channel.schema_name == ros_messages::grid_type().name) return MessageKind::force;
  if (channel.schema_name == ros_messages::contacts_type().name) return MessageKind::contacts;
  return MessageKind::none;
}

bool is_tactile_state(const McapChannel& channel) {
  return channel.schema_name == ros_messages::kTactileState;
}

Result<FrameShape> decode_counts(const McapChannel& channel, std::span<const std::uint8_t> message, RawFrame& frame) {
  if (is_tactile_state(channel)) return ros_messages::decode_tactile_state(message, frame);
  return ros_messages::decode_image(message, frame);
}

}  // namespace dermis::bytes::recordings
