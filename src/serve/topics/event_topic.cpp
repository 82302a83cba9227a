// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "serve/topics/event_topic.hpp"

#include <utility>

namespace dermis::serve {

EventTopic::EventTopic(std::string name, const messages::MessageType& type, stream::Server& server,
                       SuitRecorder& recorder)
    : name_(std::move(name)),
      type_(type),
      server_(server),
      recorder_(recorder),
      channel_(server.add_channel(name_, type.name, type.definition)) {}

void EventTopic::show(Nanos time, std::span<const std::uint8_t> message) {
  if (server_.has_subscribers(channel_)) server_.publish(channel_, time, message);
}

void EventTopic::publish(Nanos time, std::span<const std::uint8_t> message) {
  show(time, message);
  recorder_.write({name_, type_, time, message});
}

}  // namespace dermis::serve
