// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "recordings/message_kind.hpp"

#include "dermis/messages/ros_messages.hpp"

namespace dermis::recordings {

MessageKind kind_of(const McapChannel& channel) {
  if (channel.encoding != "cdr") return MessageKind::none;
  if (channel.schema_name == messages::image_type().name) return MessageKind::image;
  if (channel.schema_name == messages::acquisition_type().name) return MessageKind::acquisition;
  if (channel.schema_name == messages::temperature_type().name) return MessageKind::temperature;
  return MessageKind::none;
}

}  // namespace dermis::recordings
