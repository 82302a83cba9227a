// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "dermis/core/result.hpp"
#include "dermis/live/live_suit.hpp"
#include "dermis/messages/live_messages.hpp"
#include "dermis/serve/served_suit.hpp"
#include "serve/array_recognition.hpp"
#include "serve/event_topic.hpp"

namespace dermis::serve {

/// The topics /<array>/recognition of docs/stream.md. Thread-safe: each array on a thread of its own.
class RecognitionPublisher {
 public:
  /// `suit`, `server` and `recorder` must outlive it. Fails, as "array 'chest': ...", where classes do not fit theirs.
  [[nodiscard]] static Result<RecognitionPublisher> create(const ServedSuit& suit, stream::Server& server,
                                                           SuitRecorder& recorder);

  void publish(const live::ArrayResult& result);

 private:
  /// An array whose touches have names.
  struct Named {
    ArrayRecognition recognition;
    const std::string& frame_id;
    EventTopic topic;
    std::vector<std::size_t> order{};
    std::vector<messages::Hypothesis> results{};
    std::vector<std::uint8_t> message{};
  };

  std::vector<std::optional<Named>> arrays_;
};

/// Fills `results` with the answer, as docs/stream.md has it; `order` is used for sorting.
void results_of(const recognition::Answer& answer, const recognition::Classes& classes, std::vector<std::size_t>& order,
                std::vector<messages::Hypothesis>& results);

}  // namespace dermis::serve
