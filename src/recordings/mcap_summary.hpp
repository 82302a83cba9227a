// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "recordings/mcap_batch.hpp"
#include "recordings/mcap_bytes.hpp"

namespace dermis::recordings {

/// What the end of a file tells of the records in it.
struct McapSummary {
  IndexRecords chunk_indexes;
  IndexRecords attachment_indexes;
  IndexRecords metadata_indexes;
  std::vector<std::uint64_t> channel_messages;  ///< Of each channel from 1 on.
  std::uint64_t first_time = std::numeric_limits<std::uint64_t>::max();
  std::uint64_t last_time = 0;

  /// The batch is in the file.
  void keep(const Batch& batch);
  /// Takes the indexes of a batch back that is not.
  void cut();
  void append_statistics(std::size_t schemas, std::size_t channels, Bytes& bytes) const;
};

}  // namespace dermis::recordings
