// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "dermis/core/frames.hpp"
#include "dermis/messages/ros_messages.hpp"
#include "dermis/stream/server.hpp"
#include "serve/recording/suit_recorder.hpp"

namespace dermis::serve {

/// A topic of messages that belong to no frame: they go to clients and into recordings. Thread-safe.
class EventTopic {
 public:
  /// `type`, `server` and `recorder` must outlive it.
  EventTopic(std::string name, const messages::MessageType& type, stream::Server& server, SuitRecorder& recorder);

  /// To clients alone.
  void show(Nanos time, std::span<const std::uint8_t> message);
  /// To clients and into the recording that goes on.
  void publish(Nanos time, std::span<const std::uint8_t> message);

 private:
  std::string name_;
  const messages::MessageType& type_;
  stream::Server& server_;
  SuitRecorder& recorder_;
  stream::ChannelId channel_;
};

}  // namespace dermis::serve
