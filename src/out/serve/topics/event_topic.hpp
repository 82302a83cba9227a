// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "dermis/bytes/ros_messages/ros_messages.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"
#include "out/serve/recording/suit_recorder.hpp"
#include "out/serve/topics/topics.hpp"

namespace dermis::out::serve {

/// A topic of messages that belong to no frame: they go to both ends and into recordings. Thread-safe.
class EventTopic {
 public:
  /// `names` has one for the stream, which recordings take, too. `type`, `topics` and `recorder` must outlive it.
  /// Errors: those of Topics::add().
  [[nodiscard]] static Result<EventTopic> create(const TopicNames& names, const bytes::ros_messages::MessageType& type,
                                                 Topics& topics, SuitRecorder& recorder);

  /// To those who listen alone.
  void show(Nanos time, std::span<const std::uint8_t> message);
  /// To those who listen and into the recording that goes on.
  void publish(Nanos time, std::span<const std::uint8_t> message);

 private:
  EventTopic(std::string name, const bytes::ros_messages::MessageType& type, const Topic& topic,
             SuitRecorder& recorder);

  std::string name_;
  const bytes::ros_messages::MessageType* type_;
  Topic topic_;
  SuitRecorder* recorder_;
};

}  // namespace dermis::out::serve
