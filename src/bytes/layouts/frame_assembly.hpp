// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bytes/layouts/frame_fields.hpp"
#include "dermis/bytes/layouts/decoder.hpp"
#include "dermis/bytes/layouts/layout.hpp"
#include "dermis/touch/frames/frames.hpp"

namespace dermis::bytes::layouts {

/// Makes frames of one array from pieces.
class FrameAssembly {
 public:
  FrameAssembly(const Layout& layout, std::size_t array, const Moduli& moduli);

  /// Adds a piece of `bytes` bytes with these numbers; those of a run that reach beyond the array are none of it. True
  /// where it completes a frame, which it then writes.
  [[nodiscard]] bool add(const Piece& piece, std::span<const float> numbers, std::size_t bytes, RawFrame& frame);

  /// The next piece begins a frame.
  void end_frame();
  /// Bytes that belong to no frame.
  void skip(std::size_t bytes) noexcept { counts_.skipped_bytes += bytes; }
  /// A frame that was recognised and cannot be right.
  void damage(std::size_t bytes) noexcept;

  [[nodiscard]] const DecoderCounts& counts() const noexcept { return counts_; }
  /// Says why no frame is complete, where pieces have come.
  [[nodiscard]] std::string advice() const;

 private:
  [[nodiscard]] std::optional<std::size_t> begin_of(const Piece& piece, std::size_t count) const noexcept;
  [[nodiscard]] bool has_come(std::size_t begin, std::size_t count) const noexcept;
  [[nodiscard]] bool begins_again(std::size_t begin, std::size_t count) const noexcept;
  bool is_outside(const Piece& piece);
  void begin_frame(const Piece& piece);
  void fill(std::size_t begin, std::span<const float> numbers);
  [[nodiscard]] bool deliver(RawFrame& frame);

  std::size_t array_;
  FrameShape shape_;
  FrameFields fields_;

  std::vector<float> readings_;
  std::vector<std::uint32_t> filled_in_;  ///< The frame in which a reading came last, as of number_.
  std::uint32_t number_ = 0;              ///< Of the frame that is being read, from 1 on.
  std::size_t last_end_ = 0;              // of the part before
  std::size_t filled_ = 0;
  std::size_t bytes_ = 0;
  std::size_t most_filled_ = 0;   ///< The most of a frame that was not complete.
  std::optional<Piece> outside_;  ///< The last that the array does not have.
  Piece first_;                   ///< Of the frame that is being read.
  DecoderCounts counts_;
};

}  // namespace dermis::bytes::layouts
