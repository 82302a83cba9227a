// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "dermis/touch/frames/frame_source.hpp"
#include "dermis/touch/frames/frames.hpp"

namespace dermis::bytes::layouts {

/// Result of the bytes so far.
struct DecoderCounts {
  std::uint64_t frames = 0;           ///< Delivered.
  std::uint64_t lost_frames = 0;      ///< Gaps in the numbers of the device.
  std::uint64_t damaged_frames = 0;   ///< Recognised and dropped: checksum, length or content cannot be right.
  std::uint64_t late_frames = 0;      ///< Came after later ones, by the device's clock: put in order or dropped.
  std::uint64_t repeated_frames = 0;  ///< With the number, time and readings of the one before: dropped.
  std::uint64_t skipped_bytes = 0;    ///< Bytes that belong to no delivered frame, those of damaged frames included.

  bool operator==(const DecoderCounts&) const = default;
};

/// Turns the bytes of one device into frames. A pure function of the bytes: frames and counts do not depend on how the
/// bytes are cut into pieces. Bytes may be anything; memory stays bounded (a few frames). After bytes were dropped,
/// inserted or flipped, at most two frames besides the damaged ones pass before frames are delivered again. Not
/// thread-safe.
class Decoder {
 public:
  Decoder() = default;
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;
  virtual ~Decoder() = default;

  /// Adds the next bytes of the stream, at most kMaxPush. Before more, next() must be called until it returns false.
  virtual void push(std::span<const std::uint8_t> bytes) = 0;
  static constexpr std::size_t kMaxPush = 65536;

  /// Fills counts, temperature and supply. In `frame.acquisition` it fills sequence, device_time, lost_before and
  /// held_taxels. The caller sets time and arrivals. Returns false if the bytes so far hold no further whole frame.
  /// Allocates nothing after the first frame.
  [[nodiscard]] virtual bool next(RawFrame& frame) = 0;

  /// Call it when no byte has come for 100 ms. next() then delivers a whole frame that only waits for its successor. An
  /// incomplete frame stays. Protocols of text lines also learn from these pauses.
  virtual void idle() {}

  /// The stream ended or was interrupted here. next() then delivers a whole frame that only waited for its successor.
  /// An incomplete frame is dropped. Learned values (size, offsets) stay, and push() may continue.
  virtual void finish() = 0;

  /// Number of bytes pushed since the beginning up to and including the last byte of the last frame of next().
  [[nodiscard]] virtual std::uint64_t frame_end() const noexcept = 0;

  /// Shape of the frames; empty until it is known.
  [[nodiscard]] virtual std::optional<FrameShape> shape() const noexcept = 0;

  [[nodiscard]] virtual const DecoderCounts& counts() const noexcept = 0;

  /// Bytes that the device needs before it sends its next frame. Send them when a connection opens, after each frame,
  /// and after a second of silence. Empty for devices that send on their own, and while they do.
  [[nodiscard]] virtual std::string_view request() const noexcept { return {}; }

  /// Says what bytes that hold no frame lack, and the mend; empty where nothing is known.
  [[nodiscard]] virtual std::string advice() const { return {}; }

  /// The shape that frames would likely have, where the bytes hold no frame; empty where nothing is known.
  [[nodiscard]] virtual std::optional<FrameShape> likely_shape() const { return {}; }

  /// The name of the protocol that "auto" has detected; empty until then, and for decoders of one protocol.
  [[nodiscard]] virtual std::string_view detected_protocol() const noexcept { return {}; }
};

}  // namespace dermis::bytes::layouts
