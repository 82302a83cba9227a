// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "recordings/mcap_summary.hpp"

#include <algorithm>

namespace dermis::recordings {

void McapSummary::keep(const Batch& batch) {
  for (IndexRecords* records : {&chunk_indexes, &attachment_indexes, &metadata_indexes}) records->keep();
  constexpr std::size_t kEntryBytes = 16;
  if (channel_messages.size() < batch.indexes.size()) channel_messages.resize(batch.indexes.size());
  for (std::size_t i = 0; i < batch.indexes.size(); ++i) channel_messages[i] += batch.indexes[i].size() / kEntryBytes;
  if (batch.chunk.empty()) return;
  first_time = std::min(first_time, batch.first_time);
  last_time = std::max(last_time, batch.last_time);
}

void McapSummary::cut() {
  for (IndexRecords* records : {&chunk_indexes, &attachment_indexes, &metadata_indexes}) records->cut();
}

void McapSummary::append_statistics(std::size_t schemas, std::size_t channels, Bytes& bytes) const {
  constexpr std::size_t kEntryBytes = 2 + 8;
  std::uint64_t messages = 0;
  for (const std::uint64_t count : channel_messages) messages += count;
  const Record record(bytes, Opcode::statistics);
  append_number(bytes, messages);
  append_number(bytes, static_cast<std::uint16_t>(schemas));
  append_number(bytes, static_cast<std::uint32_t>(channels));
  append_number(bytes, attachment_indexes.count);
  append_number(bytes, metadata_indexes.count);
  append_number(bytes, chunk_indexes.count);
  append_number(bytes, messages == 0 ? 0 : first_time);
  append_number(bytes, last_time);
  append_number(bytes, static_cast<std::uint32_t>(kEntryBytes * channels));
  for (std::size_t i = 0; i < channels; ++i) {
    append_number(bytes, static_cast<std::uint16_t>(i + 1));
    append_number(bytes, i < channel_messages.size() ? channel_messages[i] : 0);
  }
}

}  // namespace dermis::recordings
