// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/topics/event_topic.hpp"

#include <utility>

namespace dermis::out::serve {

Result<EventTopic> EventTopic::create(const TopicNames& names, const bytes::ros_messages::MessageType& type,
                                      Topics& topics, SuitRecorder& recorder) {
  const Result<Topic> topic = topics.add(names, type);
  if (!topic) return topic.error();
  return EventTopic(names.stream, type, *topic, recorder);
}

EventTopic::EventTopic(std::string name, const bytes::ros_messages::MessageType& type, const Topic& topic,
                       SuitRecorder& recorder)
    : name_(std::move(name)), type_(&type), topic_(topic), recorder_(&recorder) {}

void EventTopic::show(Nanos time, std::span<const std::uint8_t> message) {
  topic_.publish(time, message);
}

void EventTopic::publish(Nanos time, std::span<const std::uint8_t> message) {
  show(time, message);
  recorder_->write({name_, *type_, time, message});
}

}  // namespace dermis::out::serve
