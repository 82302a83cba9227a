// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "dermis/recordings/mcap.hpp"
#include "recordings/mcap_bytes.hpp"

namespace dermis::recordings {

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

void append_map(Bytes& bytes, const std::map<std::string, std::string>& values);
void append_schema(Bytes& bytes, std::uint16_t id, const McapChannel& channel);
void append_channel(Bytes& bytes, std::uint16_t id, const WrittenChannel& channel);

}  // namespace dermis::recordings
