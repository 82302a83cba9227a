// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "dermis/bytes/recordings/suit_recording.hpp"
#include "dermis/touch/frames/frames.hpp"
#include "dermis/touch/frames/result.hpp"

/// The recording of one array in pieces, for networks: its description, then batches of frames. The description,
/// followed by batches, is an MCAP file that was cut off before its index (docs/recordings.md).
namespace dermis::bytes::recordings {

/// Frames, or contacts of frames, for the network.
struct FrameBatch {
  Nanos first{};  ///< Time of its first frame.
  Nanos last{};
  std::size_t frames = 0;
  std::vector<std::uint8_t> bytes;  ///< A chunk of MCAP, compressed by zstd.
};

/// Collects the frames of an array into batches. Thread-safe: one thread adds, another takes.
class FrameBatchWriter {
 public:
  static constexpr Nanos kLongest = std::chrono::milliseconds(100);  ///< From the first to the last frame of a batch.
  static constexpr std::size_t kMostWaitingBytes = std::size_t{16} << 20U;  ///< Before they are compressed.

  explicit FrameBatchWriter(RecordedArray array);
  FrameBatchWriter(const FrameBatchWriter&) = delete;
  FrameBatchWriter& operator=(const FrameBatchWriter&) = delete;
  ~FrameBatchWriter();

  [[nodiscard]] std::span<const std::uint8_t> description() const noexcept;

  /// Never waits. A frame for which there is no room is left out, and the next one says how many before it are lost.
  void add(const RawFrame& frame);
  [[nodiscard]] std::uint64_t left_out() const noexcept;
  /// A message dermis_msgs/msg/Contacts of the array, for batches of their own. Never waits. One for which there is no
  /// room is left out. Another thread than that of add() may call it.
  void add_contacts(Nanos time, std::span<const std::uint8_t> message);

  /// The oldest batch that is whole; with `unfinished`, the begun one, too. Empty where there is none.
  [[nodiscard]] std::optional<FrameBatch> take(bool unfinished);
  [[nodiscard]] std::optional<FrameBatch> take_contacts(bool unfinished);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// CRC-32 as in zlib. Batches have one in themselves, descriptions have not.
[[nodiscard]] std::uint32_t checksum(std::span<const std::uint8_t> bytes) noexcept;

/// The array of a description. Accepts any bytes; fails on those of none.
[[nodiscard]] Result<RecordedArray> read_description(std::span<const std::uint8_t> description);

/// Frames from the network, and their array.
struct ReadBatch {
  RecordedArray array;
  std::vector<RawFrame> frames;
};

/// Every RawFrame has the bits that were written. Fails on bytes that are no batch of this description.
[[nodiscard]] Result<ReadBatch> read_frame_batch(std::span<const std::uint8_t> description,
                                                 std::span<const std::uint8_t> batch);

}  // namespace dermis::bytes::recordings
