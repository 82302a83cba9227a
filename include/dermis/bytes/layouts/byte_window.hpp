// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>

#include "dermis/bytes/layouts/decoder.hpp"

namespace dermis::bytes::layouts {

/// The bytes of a stream that a decoder has not yet made up its mind about: added at the end, dropped at the front.
class ByteWindow {
 public:
  void push(std::span<const std::uint8_t> bytes) {
    if (bytes.size() > capacity_ - end_) make_room(bytes.size());
    std::copy(bytes.begin(), bytes.end(), buffer_.get() + end_);
    end_ += bytes.size();
  }

  [[nodiscard]] std::span<const std::uint8_t> bytes() const noexcept { return {buffer_.get() + begin_, end_ - begin_}; }

  void drop(std::size_t count) noexcept {
    begin_ += count;
    position_ += count;
  }

  /// Number of bytes dropped since the beginning of the stream: the position of bytes().front().
  [[nodiscard]] std::uint64_t position() const noexcept { return position_; }

 private:
  /// Moves what is kept to the front: as half of the buffer is then free, each byte is moved once on average.
  void make_room(std::size_t count) {
    const std::size_t kept = end_ - begin_;
    const std::size_t needed = kept + std::max(count, Decoder::kMaxPush);
    if (needed > capacity_ / 2) {
      capacity_ = 4 * needed;  // more than needed: frames that wait differ in size
      auto larger = std::make_unique_for_overwrite<std::uint8_t[]>(capacity_);
      std::copy(buffer_.get() + begin_, buffer_.get() + end_, larger.get());
      buffer_ = std::move(larger);
    } else {
      std::copy(buffer_.get() + begin_, buffer_.get() + end_, buffer_.get());
    }
    end_ = kept;
    begin_ = 0;
  }

  std::unique_ptr<std::uint8_t[]> buffer_;
  std::size_t capacity_ = 0;
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  std::uint64_t position_ = 0;
};

}  // namespace dermis::bytes::layouts
