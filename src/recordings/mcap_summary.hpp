// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "recordings/mcap_bytes.hpp"

namespace dermis::recordings {

/// What the end of a file tells of the batches in it.
struct McapSummary {
  /// The sizes up to the end of a batch.
  struct Written {
    std::uint64_t file_bytes = 0;
    std::size_t record_bytes = 0;
    std::uint32_t data_crc = 0;
  };

  Bytes records;  ///< Schemas, channels and indexes in the order of the file, also of a batch that is being written.
  std::vector<Written> batches;

  /// The batch is in the file, with these bytes.
  void keep_batch(ByteView bytes);
  /// The batch is not in the file.
  void drop_batch();
  /// Takes the last batches back until the file has its end within `room` bytes; the first one stays.
  void cut_batches(std::uint64_t room);
  [[nodiscard]] Written written() const;
  /// Data end, summary, summary offsets and footer.
  [[nodiscard]] Bytes end_of_file() const;
};

}  // namespace dermis::recordings
