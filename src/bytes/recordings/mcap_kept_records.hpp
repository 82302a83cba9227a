// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "bytes/recordings/mcap_scanner.hpp"
#include "dermis/bytes/recordings/mcap.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::recordings {

/// Attachments and metadata of a file, those beyond 64 MiB left out.
struct KeptRecords {
  std::vector<McapAttachment> attachments;
  std::vector<McapMetadata> metadata;
  std::size_t bytes = 0;
  std::uint64_t end = 0;                                ///< End of the last record that was kept.
  std::vector<std::pair<Opcode, std::uint64_t>> index;  ///< Their places.
  std::uint64_t count = 0;                              ///< How many the index should have.
  bool is_complete = false;                             ///< All are known from the index.

  /// An attachment or metadata.
  [[nodiscard]] Status add(const McapRecord& record);
  /// Forgets them, and keeps the index.
  void clear();
};

}  // namespace dermis::bytes::recordings
