// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <vector>

#include "dermis/touch/frames/frames.hpp"

namespace dermis::live::suits {

/// Frames that were acquired and wait for the pipeline, the oldest first. None is copied, and their memory is used
/// again. Not thread-safe.
class WaitingFrames {
 public:
  [[nodiscard]] bool empty() const noexcept { return count_ == 0; }
  [[nodiscard]] std::size_t size() const noexcept { return count_; }
  [[nodiscard]] RawFrame& front() noexcept { return ring_[first_]; }
  void pop() noexcept {
    first_ = (first_ + 1) % ring_.size();
    --count_;
  }

  /// The frame behind the last one, to be filled. It waits from push() on, which must follow before the next one.
  [[nodiscard]] RawFrame& room();
  void push() noexcept { ++count_; }

 private:
  std::vector<RawFrame> ring_ = std::vector<RawFrame>(2);
  std::size_t first_ = 0;
  std::size_t count_ = 0;
};

}  // namespace dermis::live::suits
