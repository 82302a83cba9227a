// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/recordings/mcap_batch.hpp"

#include <algorithm>
#include <cassert>
#include <limits>
#include <utility>

#include "bytes/recordings/crc32.hpp"
#include "dermis/touch/frames/version.hpp"

namespace dermis::bytes::recordings {
namespace {

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

bool has_same_schema(const McapChannel& a, const McapChannel& b) {
  return a.schema_name == b.schema_name && a.schema_encoding == b.schema_encoding && a.schema == b.schema;
}

}  // namespace

void BatchBuilder::begin_file() {
  append_characters(batch_.records, kMcapMagic);
  const Record header(batch_.records, Opcode::header);
  append_text(batch_.records, "ros2");
  append_text(batch_.records, "dermis " DERMIS_VERSION);
}

std::uint16_t BatchBuilder::schema_id(const McapChannel& channel) {
  if (channel.schema_name.empty()) return 0;
  const auto found = std::find_if(schemas_.begin(), schemas_.end(),
                                  [&](const McapChannel& schema) { return has_same_schema(schema, channel); });
  const auto id = static_cast<std::uint16_t>(found - schemas_.begin() + 1);
  if (found == schemas_.end()) {
    schemas_.push_back(channel);
    for (Bytes* const bytes : {&batch_.records, &batch_.declarations}) append_schema(*bytes, id, channel);
  }
  return id;
}

std::uint16_t BatchBuilder::add_channel(const McapChannel& channel) {
  assert(channels_.size() < std::numeric_limits<std::uint16_t>::max());
  WrittenChannel added;
  added.description = channel;
  added.schema_id = schema_id(channel);
  channels_.push_back(std::move(added));
  const auto id = static_cast<std::uint16_t>(channels_.size());
  for (Bytes* const bytes : {&batch_.records, &batch_.declarations}) append_channel(*bytes, id, channels_.back());
  return id;
}

void BatchBuilder::add_attachment(const McapAttachment& attachment) {
  Bytes& bytes = batch_.records;
  PlacedRecord placed{Opcode::attachment_index, bytes.size(), 0, {}};
  {
    const Record record(bytes, Opcode::attachment);
    const std::size_t begin = bytes.size();
    append_number(bytes, std::uint64_t{0});  // log time
    append_number(bytes, std::uint64_t{0});  // create time
    append_text(bytes, attachment.name);
    append_text(bytes, attachment.media_type);
    append_number(bytes, std::uint64_t{attachment.data.size()});
    append_characters(bytes, attachment.data);
    append_number(bytes, crc32(0, ByteView(bytes).subspan(begin)));
  }
  placed.bytes = bytes.size() - placed.offset;
  append_number(placed.rest, std::uint64_t{0});  // log time
  append_number(placed.rest, std::uint64_t{0});  // create time
  append_number(placed.rest, std::uint64_t{attachment.data.size()});
  append_text(placed.rest, attachment.name);
  append_text(placed.rest, attachment.media_type);
  batch_.placed.push_back(std::move(placed));
}

void BatchBuilder::add_metadata(const McapMetadata& metadata) {
  Bytes& bytes = batch_.records;
  PlacedRecord placed{Opcode::metadata_index, bytes.size(), 0, {}};
  {
    const Record record(bytes, Opcode::metadata);
    append_text(bytes, metadata.name);
    append_map(bytes, metadata.values);
  }
  placed.bytes = bytes.size() - placed.offset;
  append_text(placed.rest, metadata.name);
  batch_.placed.push_back(std::move(placed));
}

void BatchBuilder::add_message(const McapMessage& message) {
  assert(message.channel >= 1 && message.channel <= channels_.size());
  Bytes& chunk = batch_.chunk;
  if (chunk.empty()) batch_.first_time = batch_.last_time = message.log_time;
  batch_.first_time = std::min(batch_.first_time, message.log_time);
  batch_.last_time = std::max(batch_.last_time, message.log_time);
  if (batch_.indexes.size() < channels_.size()) batch_.indexes.resize(channels_.size());
  Bytes& index = batch_.indexes[message.channel - 1U];
  append_number(index, message.log_time);
  append_number(index, std::uint64_t{chunk.size()});
  const Record record(chunk, Opcode::message);
  append_number(chunk, message.channel);
  append_number(chunk, message.sequence);
  append_number(chunk, message.log_time);
  append_number(chunk, message.publish_time);
  append_bytes(chunk, message.data);
}

std::size_t append_chunk(Bytes& bytes, const Batch& batch, McapCompression compression, Compressor& compressor) {
  const Record record(bytes, Opcode::chunk);
  append_number(bytes, batch.first_time);
  append_number(bytes, batch.last_time);
  append_number(bytes, std::uint64_t{batch.chunk.size()});
  append_number(bytes, crc32(0, batch.chunk));
  append_text(bytes, to_string(compression));
  const LengthBefore<std::uint64_t> length(bytes);
  const std::size_t begin = bytes.size();
  compressor.append(batch.chunk, bytes);
  return bytes.size() - begin;
}

}  // namespace dermis::bytes::recordings
