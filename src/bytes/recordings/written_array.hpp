// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bytes/recordings/message_kind.hpp"
#include "dermis/bytes/recordings/mcap.hpp"
#include "dermis/bytes/recordings/suit_recording.hpp"
#include "dermis/bytes/ros_messages/ros_messages.hpp"
#include "dermis/touch/frames/frames.hpp"

namespace dermis::bytes::recordings {

/// Log time of a message. It is not that of the arrival by UTC, which leaps when that clock is set.
[[nodiscard]] std::uint64_t log_time_of(Nanos time);

/// The metadata with which a recording describes an array.
[[nodiscard]] McapMetadata metadata_of(const RecordedArray& array);

/// An array whose frames become messages.
class WrittenArray {
 public:
  explicit WrittenArray(RecordedArray description);

  [[nodiscard]] const RecordedArray& description() const noexcept { return description_; }
  [[nodiscard]] std::uint64_t frames() const noexcept { return frames_; }

  /// Makes the messages of a frame. `force` may be null.
  void encode(const RawFrame& frame, const ForceFrame* force);
  /// Adds the messages to a McapWriter or a BatchBuilder. Channels are declared with their first message.
  template <typename Mcap>
  void add_to(Mcap& mcap);
  /// Declares the channels of raw frames.
  template <typename Mcap>
  void declare(Mcap& mcap);

 private:
  struct Topic {
    const char* name;
    const ros_messages::MessageType& type;
    std::optional<std::uint16_t> channel{};
    std::vector<std::uint8_t> message{};
    bool is_in_frame = false;
  };

  void encode_sensors(const RawFrame& frame);
  template <typename Mcap>
  void declare(Mcap& mcap, Topic& topic);

  RecordedArray description_;
  std::string frame_id_;
  // In the order of the file. The image comes last: a frame whose image is there is whole.
  Topic temperature_{"temperature", ros_messages::temperature_type()};
  Topic sensors_{kSensorsTopic, ros_messages::image_type()};
  Topic acquisition_{"acquisition", ros_messages::acquisition_type()};
  Topic force_status_{"force_status", ros_messages::frame_status_type()};
  Topic force_{"force", ros_messages::grid_type()};
  Topic raw_{"raw", ros_messages::image_type()};
  std::uint64_t frames_ = 0;
  std::uint64_t log_time_ = 0;
};

template <typename Mcap>
void WrittenArray::declare(Mcap& mcap, Topic& topic) {
  if (topic.channel) return;
  const std::string full_name = "/" + frame_id_ + "/" + topic.name;
  topic.channel = mcap.add_channel({full_name, "cdr", topic.type.name, "ros2msg", topic.type.definition});
}

template <typename Mcap>
void WrittenArray::declare(Mcap& mcap) {
  for (Topic* topic : {&temperature_, &acquisition_, &raw_}) declare(mcap, *topic);
}

template <typename Mcap>
void WrittenArray::add_to(Mcap& mcap) {
  for (Topic* topic : {&temperature_, &sensors_, &acquisition_, &force_status_, &force_, &raw_}) {
    if (!topic->is_in_frame) continue;
    declare(mcap, *topic);
    mcap.add_message({*topic->channel, static_cast<std::uint32_t>(frames_), log_time_, log_time_, topic->message});
  }
  ++frames_;
}

}  // namespace dermis::bytes::recordings
