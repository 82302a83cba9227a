// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "dermis/bytes/ros_messages/live_messages.hpp"
#include "dermis/live/suits/live_suit.hpp"
#include "dermis/out/serve/served_suit.hpp"
#include "dermis/touch/frames/result.hpp"
#include "out/serve/parts/part.hpp"
#include "out/serve/recognition/live_recognition.hpp"
#include "out/serve/topics/event_topic.hpp"

namespace dermis::out::serve {

/// The topics /<array>/recognition of docs/stream.md. Thread-safe: each array on a thread of its own.
class RecognitionPublisher final : public Part {
 public:
  /// All must outlive it. An array without classes has no topic in the stream. On DDS each array has one, as it may be
  /// taught classes. Errors: those of Topics::add().
  [[nodiscard]] static Result<std::unique_ptr<RecognitionPublisher>> create(const ServedSuit& suit, Topics& topics,
                                                                            SuitRecorder& recorder);

  /// Takes the classes into use that the suit names.
  [[nodiscard]] Status prepare() override;
  /// Errors: "array 'chest': ...", where they do not fit.
  [[nodiscard]] Status use_classes(std::size_t array, const learn::recognition::Classes& classes) override;
  void hear(const live::suits::ArrayResult& result) override;

 private:
  struct Named {
    const ServedArray* array = nullptr;
    Topic nodes{};  // of ROS 2
    std::optional<EventTopic> topic{};
    std::atomic<bool> has_next = false;
    std::mutex next_mutex{};
    std::unique_ptr<LiveRecognition> next{};
    // Used by the array's thread alone.
    std::unique_ptr<LiveRecognition> recognition{};
    std::vector<std::size_t> order{};
    std::vector<bytes::ros_messages::Hypothesis> results{};
    std::vector<std::uint8_t> message{};
  };

  RecognitionPublisher(Topics& topics, SuitRecorder& recorder) : topics_(topics), recorder_(recorder) {}

  Topics& topics_;
  SuitRecorder& recorder_;
  std::deque<Named> arrays_;
};

/// Fills `results` with the answer, as docs/stream.md has it; `order` is used for sorting.
void results_of(const learn::recognition::Answer& answer, const learn::recognition::Classes& classes,
                std::vector<std::size_t>& order, std::vector<bytes::ros_messages::Hypothesis>& results);

}  // namespace dermis::out::serve
