// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
#include <thread>
#include <vector>

#include "live/dds/participant.hpp"

namespace dermis::live::dds {

/// Messages on their way to writers, on a thread of its own, in their order: who has one never waits for the network.
/// Thread-safe.
class WritingQueue {
 public:
  explicit WritingQueue(std::size_t most_bytes);
  WritingQueue(const WritingQueue&) = delete;
  WritingQueue& operator=(const WritingQueue&) = delete;
  /// Writes what waits.
  ~WritingQueue();

  /// False where there is no room. Copies the message; allocates nothing once as many have waited. `writer` must
  /// outlive the queue.
  [[nodiscard]] bool push(Writer& writer, std::span<const std::uint8_t> message);

 private:
  struct Waiting {
    Writer* writer = nullptr;
    std::vector<std::uint8_t> bytes;
  };

  void write_messages();

  const std::size_t most_bytes_;
  std::mutex mutex_;  // Of what follows.
  std::condition_variable wake_;
  bool stopping_ = false;
  std::size_t bytes_ = 0;  // Size of the messages that wait or are being written.
  std::vector<Waiting> waiting_;
  std::vector<std::vector<std::uint8_t>> spare_;
  std::thread thread_;
};

}  // namespace dermis::live::dds
