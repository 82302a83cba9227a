// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>

#include "dermis/touch/frames/frames.hpp"

namespace dermis::bytes::devices {

/// When bytes came.
struct Stamp {
  Nanos steady{};
  Nanos utc{};
};

[[nodiscard]] inline Stamp now() {
  return {std::chrono::steady_clock::now().time_since_epoch(), std::chrono::system_clock::now().time_since_epoch()};
}

/// Remembers when the bytes of a stream came that no frame has used up yet.
class ChunkStamps {
 public:
  /// `end`: number of bytes of the stream including the chunk; it rises.
  void add(std::uint64_t end, const Stamp& stamp) {
    if (count_ == chunks_.size()) drop_first();  // its bytes count as come with the next
    chunks_[(first_ + count_) % chunks_.size()] = {end, stamp};
    ++count_;
  }

  /// The stamp of the chunk that holds the last of the first `end` bytes; forgets what came before it.
  [[nodiscard]] Stamp of(std::uint64_t end) {
    while (count_ > 1 && chunks_[first_].end < end) drop_first();
    return chunks_[first_].stamp;
  }

 private:
  struct Chunk {
    std::uint64_t end = 0;
    Stamp stamp;
  };

  void drop_first() {
    first_ = (first_ + 1) % chunks_.size();
    --count_;
  }

  std::array<Chunk, 1024> chunks_{};
  std::size_t first_ = 0;
  std::size_t count_ = 0;
};

}  // namespace dermis::bytes::devices
