// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/topics/mark_book.hpp"

#include <utility>

#include "dermis/bytes/recordings/marks.hpp"
#include "dermis/out/serve/served_suit.hpp"

namespace dermis::out::serve {

using bytes::ros_messages::Mark;

Result<std::unique_ptr<MarkBook>> MarkBook::create(Topics& topics, SuitRecorder& recorder) {
  Result<EventTopic> topic = EventTopic::create({.stream = bytes::recordings::kMarksTopic},
                                                bytes::ros_messages::mark_type(), topics, recorder);
  if (!topic) return topic.error();
  return std::unique_ptr<MarkBook>(new MarkBook(*std::move(topic)));
}

void MarkBook::add(Mark mark, Nanos now) {
  const std::lock_guard lock(mutex_);
  publish(mark, now);
  if (marks_.size() == kMostMarks) marks_.erase(marks_.begin());
  marks_.push_back(std::move(mark));
}

void MarkBook::replace(std::vector<Mark> marks) {
  const std::lock_guard lock(mutex_);
  marks_ = std::move(marks);
}

std::vector<Mark> MarkBook::marks() const {
  const std::lock_guard lock(mutex_);
  return marks_;
}

void MarkBook::begin_recording(Nanos now) {
  const std::lock_guard lock(mutex_);
  for (const Mark& mark : marks_) {
    if (!mark.event.empty()) publish(mark, now);
  }
}

void MarkBook::publish(const Mark& mark, Nanos at) {
  bytes::ros_messages::encode_mark(mark, kSuitFrame, message_);
  topic_.publish(at, message_);
}

}  // namespace dermis::out::serve
