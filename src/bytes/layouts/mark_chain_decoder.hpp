// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "dermis/bytes/layouts/window_decoder.hpp"

namespace dermis::bytes::layouts {

/// Frames of constant size that begin or end with a constant mark, without length or checksum, and whose readings may
/// look like the mark. A mark differs from such readings because others stand at multiples of the frame size from it.
///
/// Frames begin where a chain of marks in a row does. Constant readings make a chain too, so those of the last frame
/// are remembered. Where several chains are left, the one is taken that goes on from the last frame but for a few
/// bytes. Otherwise none is taken until all others break.
///
/// A frame is delivered when a mark stands before and after it, or the device pauses after it: bytes were neither
/// dropped nor added.
class MarkChainDecoder : public WindowDecoder {
 protected:
  enum class MarkAt { begin, end };
  /// Whether a stream whose first bytes are a mark begins with a frame, or may begin anywhere.
  enum class FirstMark { begins_frame, may_be_readings };

  /// `mark` must outlive the decoder; `frame_sizes` are those that the device may have, mark included; one with `end`.
  MarkChainDecoder(std::span<const std::uint8_t> mark, MarkAt place, const std::vector<std::size_t>& frame_sizes,
                   FirstMark first);

  /// Mark included; empty until it is known.
  [[nodiscard]] std::optional<std::size_t> frame_size() const noexcept;

  /// Whether bytes of the size of a packet may be one, but for the mark.
  [[nodiscard]] virtual bool fits(std::span<const std::uint8_t> packet) = 0;

  /// Reads a packet, its mark included; false where it is damaged.
  [[nodiscard]] virtual bool read(std::span<const std::uint8_t> packet, RawFrame& frame) = 0;

  void begin_again() override;

  /// The place in the stream of the first mark that was seen before any chain of them.
  [[nodiscard]] std::optional<std::uint64_t> first_mark_at() const noexcept { return first_mark_at_; }

 private:
  using Bytes = std::span<const std::uint8_t>;

  struct Chain {
    std::uint64_t start;
    std::size_t frame_size;
    bool is_whole;  ///< Long enough, and no mark is missing.
  };

  /// A size that frames may have, and what is known of chains of it. Starts are places in the stream.
  struct Size {
    std::size_t bytes;
    std::uint64_t known_until = 0;  ///< No other chain starts before.
    std::vector<Chain> chains{};
  };

  Verdict judge(Bytes bytes, bool ended, RawFrame& frame) final;
  Verdict follow(Bytes bytes, bool ended, RawFrame& frame);
  Verdict search(Bytes bytes, bool ended);
  Verdict deliver(Bytes bytes, RawFrame& frame);
  Verdict pass(Bytes bytes, Verdict::Kind kind, std::size_t size);

  /// Positions count from the mark before a frame. With marks at the end of frames, that one was taken already, with
  /// the frame before: the window begins behind it.
  [[nodiscard]] std::size_t length(Bytes bytes) const noexcept { return taken_ + bytes.size(); }
  [[nodiscard]] bool mark_at(Bytes bytes, std::size_t position) const noexcept;

  [[nodiscard]] std::size_t marks_needed() const noexcept;
  void compare(std::size_t frames) noexcept;
  void forget_chains() noexcept;
  void look_for_first_mark(Bytes bytes);
  void find_chains(Bytes bytes, bool are_kept);
  void find_chains(Bytes bytes, Size& size);
  void forget_taken_marks(Size& size) const noexcept;
  void count_marks(Bytes bytes, std::size_t frame_size);
  [[nodiscard]] std::size_t missing_marks(Bytes bytes, const Chain& chain, std::size_t possible) const noexcept;
  [[nodiscard]] static bool ends_with_frame(Bytes bytes, const Chain& chain) noexcept;
  [[nodiscard]] bool is_size_of_last_frame(std::size_t size) const noexcept {
    return size == mark_.size() + last_payload_.size();
  }
  [[nodiscard]] bool is_imitation(const Chain& chain) const noexcept;
  [[nodiscard]] std::span<const Chain> chains() const noexcept;
  [[nodiscard]] const Chain* true_chain() const noexcept;

  Bytes mark_;
  std::size_t taken_;  ///< Length of the mark before the window, 0 with marks at the begin.
  FirstMark first_mark_;
  std::vector<Size> sizes_;          ///< One, once it is known.
  bool in_step_ = false;             ///< A frame begins at the front of the window.
  bool was_in_step_ = false;         ///< One would, had no bytes been lost or added since the last.
  bool after_mark_ = false;          ///< The bytes taken before the window ended with a mark.
  bool is_at_begin_ = true;          ///< Nothing of the stream was taken, and it may begin with a frame.
  std::size_t frames_compared_ = 0;  ///< Over how many frames chains are followed at present.
  std::optional<std::uint64_t> first_mark_at_;
  std::vector<std::uint8_t> last_payload_;
  std::vector<std::uint8_t> marks_in_phase_;  ///< Number of marks at each position modulo the frame size.
  std::array<Chain, 8> chains_{};             ///< That may be whole.
  std::size_t chain_count_ = 0;               ///< May exceed those that are kept.
};

}  // namespace dermis::bytes::layouts
