// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "bytes/recordings/compression.hpp"
#include "bytes/recordings/mcap_bytes.hpp"
#include "dermis/bytes/recordings/mcap.hpp"

namespace dermis::bytes::recordings {

struct WrittenChannel {
  McapChannel description;
  std::uint16_t schema_id = 0;
};

/// An attachment or metadata, and where they stand among the records of a batch.
struct PlacedRecord {
  Opcode opcode{};
  std::size_t offset = 0;
  std::size_t bytes = 0;
  Bytes rest;  ///< Rest of its index, behind place and length.
};

/// The data that go to the file at once.
struct Batch {
  Bytes records;                     ///< Whole ones, before the chunk.
  std::vector<PlacedRecord> placed;  ///< Those records that have an index.
  Bytes declarations;                ///< Their schemas and channels, for the summary.
  Bytes chunk;                       ///< The records in it.
  std::uint64_t first_time = 0;
  std::uint64_t last_time = 0;
  /// Index of each channel from 1 on: time and place of each of its messages in the chunk.
  std::vector<Bytes> indexes;

  [[nodiscard]] bool is_empty() const { return records.empty() && chunk.empty(); }
  /// With as much room.
  [[nodiscard]] Batch empty_like() const {
    Batch batch;
    batch.chunk.reserve(chunk.capacity());
    batch.indexes.resize(indexes.size());
    for (std::size_t i = 0; i < indexes.size(); ++i) batch.indexes[i].reserve(indexes[i].capacity());
    return batch;
  }
  void clear() {
    records.clear();
    placed.clear();
    declarations.clear();
    chunk.clear();
    for (Bytes& index : indexes) index.clear();
  }
};

/// Makes batches of what is added, as McapWriter documents it. The first one begins the file.
class BatchBuilder {
 public:
  void begin_file();
  [[nodiscard]] std::uint16_t add_channel(const McapChannel& channel);
  void add_attachment(const McapAttachment& attachment);
  void add_metadata(const McapMetadata& metadata);
  void add_message(const McapMessage& message);

  /// The open batch, which may be taken away or cleared.
  [[nodiscard]] Batch& batch() noexcept { return batch_; }
  [[nodiscard]] const Batch& batch() const noexcept { return batch_; }

 private:
  [[nodiscard]] std::uint16_t schema_id(const McapChannel& channel);

  Batch batch_;
  std::vector<WrittenChannel> channels_;  ///< Of the numbers 1, 2, ...
  std::vector<McapChannel> schemas_;      ///< Of the numbers 1, 2, ...
};

/// Appends the chunk of the batch, compressed; returns its compressed size.
std::size_t append_chunk(Bytes& bytes, const Batch& batch, McapCompression compression, Compressor& compressor);

}  // namespace dermis::bytes::recordings
