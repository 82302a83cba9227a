// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

#include "dermis/bytes/recordings/mcap.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::recordings {

/// Brings what is added to a McapWriter to the disk, chunk by chunk, while more is added. Thread-safe.
class ChunkWriting {
 public:
  /// Adds a frame or an event to the writer.
  using Add = std::function<void(McapWriter&)>;

  /// A chunk ends after 50 ms, or with `chunk_bytes`. `live`: the file appears with the first.
  ChunkWriting(std::unique_ptr<McapWriter> mcap, std::size_t chunk_bytes, bool live);
  ChunkWriting(const ChunkWriting&) = delete;
  ChunkWriting& operator=(const ChunkWriting&) = delete;
  /// Without finish(), the chunks up to here are written, and the end of the file is not.
  ~ChunkWriting();

  /// Chunks that wait for a disk that stalls: 64 MB.
  [[nodiscard]] std::size_t most_chunks() const noexcept;
  /// Waits where so many wait. Fails where the file could not be written.
  [[nodiscard]] Status add(const Add& add);
  /// As add(), but false where `most_chunks` wait.
  [[nodiscard]] Result<bool> try_add(const Add& add, std::size_t most_chunks);
  /// Writes all that waits, `last`, and the end of the file.
  [[nodiscard]] Status finish(const Add& last);
  /// Before the first add().
  [[nodiscard]] McapWriter& mcap() noexcept;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace dermis::bytes::recordings
