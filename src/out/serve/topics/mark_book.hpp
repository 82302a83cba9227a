// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <vector>

#include "dermis/bytes/ros_messages/ros_messages.hpp"
#include "dermis/touch/frames/result.hpp"
#include "out/serve/recording/suit_recorder.hpp"
#include "out/serve/topics/event_topic.hpp"
#include "out/serve/topics/topics.hpp"

namespace dermis::out::serve {

/// Moments with a name, set by people, and by the server where a zero changes. They go to clients and into the
/// recording, and stay for clients who come later. Thread-safe.
class MarkBook {
 public:
  static constexpr std::size_t kMostMarks = 1000;

  /// `topics` and `recorder` must outlive it. Errors: those of Topics::add().
  [[nodiscard]] static Result<std::unique_ptr<MarkBook>> create(Topics& topics, SuitRecorder& recorder);

  void add(bytes::ros_messages::Mark mark, Nanos now);
  /// Those of a recording that is played, in place of all.
  void replace(std::vector<bytes::ros_messages::Mark> marks);
  /// The oldest first.
  [[nodiscard]] std::vector<bytes::ros_messages::Mark> marks() const;
  /// A recording that begins now is told which zeros were taken before it.
  void begin_recording(Nanos now);

 private:
  explicit MarkBook(EventTopic topic) : topic_(std::move(topic)) {}
  void publish(const bytes::ros_messages::Mark& mark, Nanos at);

  mutable std::mutex mutex_;
  EventTopic topic_;
  std::vector<bytes::ros_messages::Mark> marks_;
  std::vector<std::uint8_t> message_;
};

}  // namespace dermis::out::serve
