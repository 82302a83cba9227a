// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "dermis/bytes/layouts/byte_window.hpp"

namespace dermis::bytes::layouts {

/// Lines of a stream, each with the byte that ends it. Lines that were read are kept until they are forgotten, so that
/// they can be read again.
class LineReader {
 public:
  explicit LineReader(std::size_t longest_line, std::uint8_t end = '\n') : longest_line_(longest_line), end_(end) {}

  void push(std::span<const std::uint8_t> bytes) { window_.push(bytes); }

  /// The next line with its end, empty where it has not come yet. Where no end comes within the longest line, so many
  /// bytes without it.
  [[nodiscard]] std::span<const std::uint8_t> next() {
    const std::span<const std::uint8_t> rest = window_.bytes().subspan(read_);
    const std::size_t reach = std::min(rest.size(), longest_line_);
    const void* end = reach > searched_ ? std::memchr(rest.data() + searched_, end_, reach - searched_) : nullptr;
    searched_ = reach;
    if (end == nullptr && reach < longest_line_) return {};
    const std::size_t size =
        end == nullptr ? reach : static_cast<std::size_t>(static_cast<const std::uint8_t*>(end) - rest.data()) + 1;
    read_ += size;
    searched_ = 0;
    return rest.first(size);
  }

  /// Number of bytes that were read and not forgotten.
  [[nodiscard]] std::size_t kept() const noexcept { return read_; }

  /// A line has begun, and its end has not come.
  [[nodiscard]] bool has_open_line() const noexcept { return window_.bytes().size() > read_; }

  /// Forgets what was read.
  void forget() noexcept {
    window_.drop(read_);
    read_ = 0;
  }

  /// Forgets what was read and the line that has only begun; returns the size of both.
  std::size_t forget_all() noexcept {
    const std::size_t size = window_.bytes().size();
    window_.drop(size);
    read_ = searched_ = 0;
    return size;
  }

  /// Goes back to the first line that was not forgotten.
  void rewind() noexcept { read_ = searched_ = 0; }

  /// Number of bytes pushed up to the end of the line that was read last.
  [[nodiscard]] std::uint64_t position() const noexcept { return window_.position() + read_; }

 private:
  ByteWindow window_;
  std::size_t longest_line_;
  std::uint8_t end_;          // of a line
  std::size_t read_ = 0;      // bytes of lines that were read and are kept
  std::size_t searched_ = 0;  // bytes after them that are known to hold no end
};

}  // namespace dermis::bytes::layouts
