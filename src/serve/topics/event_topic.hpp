// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "dermis/core/frames.hpp"
#include "dermis/messages/ros_messages.hpp"
#include "serve/recording/suit_recorder.hpp"
#include "serve/topics/topics.hpp"

namespace dermis::serve {

/// A topic of messages that belong to no frame: they go to clients and into recordings. Thread-safe.
class EventTopic {
 public:
  /// `type`, `topics` and `recorder` must outlive it.
  EventTopic(std::string name, const messages::MessageType& type, Topics& topics, SuitRecorder& recorder);

  /// To clients alone.
  void show(Nanos time, std::span<const std::uint8_t> message);
  /// To clients and into the recording that goes on.
  void publish(Nanos time, std::span<const std::uint8_t> message);

 private:
  std::string name_;
  const messages::MessageType& type_;
  Topic topic_;
  SuitRecorder& recorder_;
};

}  // namespace dermis::serve
