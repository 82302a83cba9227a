// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/recordings/mcap_kept_records.hpp"

namespace dermis::bytes::recordings {

Status KeptRecords::add(const McapRecord& record) {
  constexpr std::size_t kMostBytes = std::size_t{64} << 20U;
  bytes += record.body.size();
  if (record.is_left_out || bytes > kMostBytes) return Done{};
  if (record.opcode == Opcode::attachment) {
    Result<McapAttachment> attachment = parse_attachment(record.body);
    if (!attachment) return attachment.error();
    attachments.push_back(*std::move(attachment));
  } else {
    Result<McapMetadata> parsed = parse_metadata(record.body);
    if (!parsed) return parsed.error();
    metadata.push_back(*std::move(parsed));
  }
  return Done{};
}

void KeptRecords::clear() {
  attachments.clear();
  metadata.clear();
  bytes = 0;
}

}  // namespace dermis::bytes::recordings
