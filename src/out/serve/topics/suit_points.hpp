// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <vector>

#include "dermis/bytes/ros_messages/live_messages.hpp"
#include "dermis/out/serve/served_suit.hpp"
#include "dermis/touch/frames/frames.hpp"

namespace dermis::out::serve {

/// The taxels of a suit in space with their last forces. Thread-safe.
class SuitPoints {
 public:
  /// `suit` must outlive it.
  explicit SuitPoints(const ServedSuit& suit);

  void keep(std::size_t array, const ForceFrame& force);

  /// All of them, as /suit/points. One at a time.
  void encode(Nanos time, std::vector<std::uint8_t>& message);

 private:
  struct ArrayPoints {
    std::mutex mutex{};
    std::vector<bytes::ros_messages::TaxelPoint> points{};  // of a body at rest
  };

  void move(std::size_t array, std::size_t first);

  const WornBody* const body_;  // null: nothing moves
  std::deque<ArrayPoints> arrays_;
  std::vector<bytes::ros_messages::TaxelPoint> all_;  // On their way out.
};

}  // namespace dermis::out::serve
