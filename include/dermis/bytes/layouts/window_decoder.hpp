// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "dermis/bytes/layouts/byte_window.hpp"
#include "dermis/bytes/layouts/decoder.hpp"

namespace dermis::bytes::layouts {

/// The verdict on the first bytes of a window.
struct Verdict {
  enum class Kind {
    undecided,  ///< More bytes are needed; at the end of the stream: nothing of what is left is a frame.
    noise,      ///< `size` bytes that are no part of any frame.
    damaged,    ///< `size` bytes (0 or more) of a frame that is dropped.
    frame,      ///< A frame of `size` bytes.
  };
  Kind kind = Kind::undecided;
  std::size_t size = 0;
};

/// A decoder that judges the bytes at the front of a window until it needs more. Derived classes recognise and read;
/// this one keeps the bytes and counts.
class WindowDecoder : public Decoder {
 public:
  void push(std::span<const std::uint8_t> bytes) final {
    idle_ = false;
    window_.push(bytes);
  }
  [[nodiscard]] bool next(RawFrame& frame) final;
  void idle() final { idle_ = true; }
  void finish() final { ended_ = true; }
  [[nodiscard]] std::uint64_t frame_end() const noexcept final { return frame_end_; }
  [[nodiscard]] const DecoderCounts& counts() const noexcept final { return counts_; }

 protected:
  /// Judges the first of `bytes`. The verdict must not depend on how many bytes follow those that it needs: else frames
  /// would depend on how the stream is cut. `ended`: none will follow. Fills `frame` where it is one, but for
  /// lost_before.
  [[nodiscard]] virtual Verdict judge(std::span<const std::uint8_t> bytes, bool ended, RawFrame& frame) = 0;

  /// No byte has come for a while: judge() may take a whole frame without what follows it.
  [[nodiscard]] bool is_idle() const noexcept { return idle_; }

  /// The place in the stream of the bytes that are judged.
  [[nodiscard]] std::uint64_t position() const noexcept { return window_.position(); }

  /// The stream was interrupted, and nothing of it is left: what follows is another one.
  virtual void begin_again() {}

 private:
  void skip(std::size_t size);

  ByteWindow window_;
  DecoderCounts counts_;
  std::uint64_t frame_end_ = 0;
  bool ended_ = false;
  bool idle_ = false;
};

}  // namespace dermis::bytes::layouts
