// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "bytes/recordings/growing_file.hpp"
#include "bytes/recordings/mcap_bytes.hpp"
#include "bytes/recordings/spilled_bytes.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::recordings {

/// The end of a file for the batches in it. The indexes of chunks, of which a day has millions, are spilled.
class McapSummary {
 public:
  /// Spills beside `path`.
  explicit McapSummary(const std::string& path) : chunk_indexes_(path), batches_(path) {}

  // Records of the batch that is being written.
  Bytes records;      ///< Behind those of earlier batches: schemas, channels, indexes of attachments and metadata.
  Bytes chunk_index;  ///< Empty where the batch has no chunk.

  /// The batch is in the file, with these bytes. It is kept also where that fails, for want of room to spill.
  [[nodiscard]] Status keep_batch(ByteView bytes);
  /// The batch is not in the file.
  void drop_batch();
  [[nodiscard]] bool has_batches() const noexcept { return batches_.size() > 0; }
  /// Takes the last batches back until the file has its end within `room` bytes; the first one stays.
  [[nodiscard]] Status cut_batches(std::uint64_t room);
  /// Up to the end of the last batch.
  [[nodiscard]] std::uint64_t file_bytes() const noexcept { return last_.file_bytes; }
  /// Data end, summary, summary offsets and footer, behind the last batch.
  [[nodiscard]] Status append_end(GrowingFile& file) const;

 private:
  /// The sizes up to the end of a batch.
  struct Written {
    std::uint64_t file_bytes = 0;
    std::uint64_t record_bytes = 0;
    std::uint64_t index_bytes = 0;
    std::uint32_t data_crc = 0;
  };

  SpilledBytes chunk_indexes_;
  SpilledBytes batches_;  ///< The written part of each of them.
  Written last_;
};

}  // namespace dermis::bytes::recordings
