// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "serve/topics/event_topic.hpp"

#include <utility>

namespace dermis::serve {

EventTopic::EventTopic(std::string name, const messages::MessageType& type, Topics& topics, SuitRecorder& recorder)
    : name_(std::move(name)), type_(type), topic_(topics.add({.stream = name_}, type).value()), recorder_(recorder) {}

void EventTopic::show(Nanos time, std::span<const std::uint8_t> message) {
  topic_.publish(time, message, Ends::stream);
}

void EventTopic::publish(Nanos time, std::span<const std::uint8_t> message) {
  show(time, message);
  recorder_.write({name_, type_, time, message});
}

}  // namespace dermis::serve
