// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "recordings/mcap_batch.hpp"

namespace dermis::recordings {

void append_map(Bytes& bytes, const std::map<std::string, std::string>& values) {
  const LengthBefore<std::uint32_t> length(bytes);
  for (const auto& [key, value] : values) {
    append_text(bytes, key);
    append_text(bytes, value);
  }
}

void append_schema(Bytes& bytes, std::uint16_t id, const McapChannel& channel) {
  const Record record(bytes, Opcode::schema);
  append_number(bytes, id);
  append_text(bytes, channel.schema_name);
  append_text(bytes, channel.schema_encoding);
  append_text(bytes, channel.schema);
}

void append_channel(Bytes& bytes, std::uint16_t id, const WrittenChannel& channel) {
  const Record record(bytes, Opcode::channel);
  append_number(bytes, id);
  append_number(bytes, channel.schema_id);
  append_text(bytes, channel.description.topic);
  append_text(bytes, channel.description.encoding);
  append_map(bytes, {});
}

}  // namespace dermis::recordings
