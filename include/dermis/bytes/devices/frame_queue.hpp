// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <vector>

#include "dermis/touch/frames/frames.hpp"

namespace dermis::bytes::devices {

/// The behaviour of push() while the queue is full.
enum class Overflow {
  wait,         ///< Waits for the reader: for recorders, which lose nothing.
  drop_oldest,  ///< Drops the oldest frame: for viewers, which want the newest.
};

struct QueueStatistics {
  std::size_t depth = 0;       ///< Frames in the queue now.
  std::size_t most_depth = 0;  ///< And at most so far.
  std::uint64_t dropped = 0;   ///< Overflow::drop_oldest.
  std::uint64_t waits = 0;     ///< Overflow::wait: times the writer had to wait (back-pressure), and
  Nanos longest_wait{};        ///< the longest of them.
};

/// A bounded queue of frames from one thread to another. Frames are swapped in and out, so buffers are reused and
/// nothing is allocated once each has been used. Thread-safe: one writer, one reader; statistics() from any.
class FrameQueue {
 public:
  FrameQueue(std::size_t capacity, Overflow overflow);

  /// Swaps `frame` in; its content afterwards has no meaning. False if the reader has left: the frame is lost.
  bool push(RawFrame& frame);

  enum class Pop {
    frame,
    timeout,  ///< No frame within the time.
    end,      ///< The writer has closed the queue, and it is empty.
  };
  /// Swaps the oldest frame out.
  [[nodiscard]] Pop pop(RawFrame& frame, Nanos timeout);

  /// The writer has no more.
  void close();
  /// The reader takes no more.
  void leave();

  [[nodiscard]] QueueStatistics statistics() const;

 private:
  void wait_for_room(std::unique_lock<std::mutex>& lock);

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<RawFrame> ring_;
  std::size_t first_ = 0;
  std::size_t count_ = 0;
  Overflow overflow_;
  bool closed_ = false;
  bool left_ = false;
  QueueStatistics statistics_;
};

}  // namespace dermis::bytes::devices
