// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/recordings/mcap_scanner.hpp"

#include <algorithm>
#include <utility>

#include "bytes/recordings/crc32.hpp"
#include "dermis/bytes/files/input.hpp"

namespace dermis::bytes::recordings {
namespace {

/// The size up to which a record is read whole.
std::uint64_t most_bytes(Opcode opcode) {
  constexpr std::uint64_t kChunkHeaderBytes = 64;
  const bool is_large = opcode == Opcode::chunk || opcode == Opcode::message || opcode == Opcode::message_index;
  return is_large ? kMaxChunkBytes + kMaxChunkBytes / 128 + kChunkHeaderBytes : kMaxAttachmentBytes;
}

std::optional<McapCompression> compression_named(std::string_view name) {
  for (const McapCompression compression : {McapCompression::none, McapCompression::lz4, McapCompression::zstd}) {
    if (name == to_string(compression)) return compression;
  }
  return std::nullopt;
}

std::optional<std::map<std::string, std::string>> parse_map(ByteReader& reader) {
  ByteReader entries(reader.consume(reader.number<std::uint32_t>()));
  std::map<std::string, std::string> values;
  while (entries.good() && !entries.rest().empty()) {
    const std::string_view key = entries.text();
    values.emplace(key, entries.text());
  }
  if (!reader.good() || !entries.good()) return std::nullopt;
  return values;
}

bool is_magic(ByteView bytes) {
  return std::equal(bytes.begin(), bytes.end(), kMcapMagic.begin(), kMcapMagic.end(),
                    [](std::uint8_t a, char b) { return a == static_cast<std::uint8_t>(b); });
}

}  // namespace

McapScanner::McapScanner(std::unique_ptr<std::istream> in, std::string name, std::uint64_t size)
    : in_(std::move(in)), name_(std::move(name)), size_(size) {}

Result<McapScanner> McapScanner::open(std::unique_ptr<std::istream> in, const std::string& name) {
  in->seekg(0, std::ios::end);
  const std::streamoff size = in->tellg();
  if (!in->good() || size < 0) return bad_input(name + ": cannot be read from its end, as MCAP is; copy it to a file");
  in->seekg(0);
  McapScanner scanner(std::move(in), name, static_cast<std::uint64_t>(size));
  const Result<ByteView> magic = scanner.read(0, kMcapMagic.size());
  if (!magic) return magic.error();
  if (!is_magic(*magic)) return bad_input(name + ": is no MCAP file: it begins with other bytes");
  scanner.crc_ = crc32(0, *magic);
  scanner.place_ = kMcapMagic.size();
  return scanner;
}

Error McapScanner::error(std::uint64_t place, const std::string& what) const {
  return bad_input(name_ + ": byte " + std::to_string(place) + ": " + what);
}

/// The bytes at a place that has as many go to bytes_.
Status McapScanner::fetch(std::uint64_t place, std::size_t count) {
  if (bytes_.size() < count) bytes_.resize(count);
  if (stream_place_ != place) in_->seekg(static_cast<std::streamoff>(place));
  in_->read(reinterpret_cast<char*>(bytes_.data()), static_cast<std::streamsize>(count));
  stream_place_ = place + count;
  if (!in_->good()) return files::read_failure(name_);
  return Done{};
}

Result<ByteView> McapScanner::read(std::uint64_t place, std::size_t count) {
  const std::uint64_t there = place < size_ ? std::min<std::uint64_t>(count, size_ - place) : 0;
  if (const Status fetched = fetch(place, static_cast<std::size_t>(there)); !fetched) return fetched.error();
  return ByteView(bytes_).first(static_cast<std::size_t>(there));
}

Result<std::optional<McapScanner::Footer>> McapScanner::footer() {
  constexpr std::size_t kFooterRecordBytes = kRecordHeaderBytes + kFooterBytes;
  constexpr std::size_t kEndBytes = kFooterRecordBytes + kMcapMagic.size();
  if (size_ < kMcapMagic.size() + kEndBytes) return std::optional<Footer>{};
  Footer footer;
  footer.place = size_ - kEndBytes;
  const Result<ByteView> bytes = read(footer.place, kEndBytes);
  if (!bytes) return bytes.error();
  const ByteView checked = bytes->first(kFooterRecordBytes - sizeof(footer.crc));
  footer.checked_bytes.assign(checked.begin(), checked.end());
  ByteReader reader(*bytes);
  const bool is_footer = reader.number<std::uint8_t>() == static_cast<std::uint8_t>(Opcode::footer) &&
                         reader.number<std::uint64_t>() == kFooterBytes;
  footer.summary = reader.number<std::uint64_t>();
  static_cast<void>(reader.number<std::uint64_t>());  // summary offsets
  footer.crc = reader.number<std::uint32_t>();
  return is_footer && is_magic(reader.rest()) ? std::optional(std::move(footer)) : std::nullopt;
}

Result<McapScanner::Step> McapScanner::next(McapRecord& record) {
  if (place_ == size_) return Step::end;
  const Result<ByteView> header = read(place_, kRecordHeaderBytes);
  if (!header) return header.error();
  record = {static_cast<Opcode>(header->front()), place_, 0, {}, false};
  if (header->front() == 0) return Step::wrong;
  if (header->size() < kRecordHeaderBytes) return Step::cut;
  ByteReader reader(header->subspan(1));
  const auto length = reader.number<std::uint64_t>();
  if (length > size_ - place_ - kRecordHeaderBytes) return Step::cut;
  record.bytes = kRecordHeaderBytes + length;
  record.is_left_out = length > most_bytes(record.opcode);
  if (record.is_left_out) {
    crc_.reset();
  } else {
    if (crc_) crc_ = crc32(*crc_, *header);
    const Status body = fetch(place_ + kRecordHeaderBytes, static_cast<std::size_t>(length));
    if (!body) return body.error();
    record.body = ByteView(bytes_).first(static_cast<std::size_t>(length));
    if (crc_) crc_ = crc32(*crc_, record.body);
  }
  place_ += record.bytes;
  return Step::record;
}

const char* to_string(McapCompression compression) noexcept {
  switch (compression) {
    case McapCompression::none: return "";
    case McapCompression::lz4: return "lz4";
    case McapCompression::zstd: return "zstd";
  }
  return "";
}

Result<McapChunk> parse_chunk(ByteView body, Decompressor& decompressor) {
  ByteReader reader(body);
  static_cast<void>(reader.number<std::uint64_t>());  // first time
  static_cast<void>(reader.number<std::uint64_t>());  // last time
  const auto size = reader.number<std::uint64_t>();
  const auto crc = reader.number<std::uint32_t>();
  const std::string_view compression_name = reader.text();
  const ByteView compressed = reader.consume(reader.number<std::uint64_t>());
  if (!reader.good()) return bad_input("the chunk is shorter than its fields say");
  const std::optional<McapCompression> compression = compression_named(compression_name);
  if (compression && !can_decompress(*compression)) {
    return bad_input("the chunk is compressed with " + std::string(compression_name) +
                     ", which a page cannot read; `dermis convert RECORDING frames.csv` writes what it can read");
  }
  if (!compression) {
    return bad_input("the chunk is compressed with '" + std::string(compression_name.substr(0, 20)) +
                     "'; lz4, zstd and no compression can be read");
  }
  if (size > kMaxChunkBytes) {
    return bad_input("the chunk has " + std::to_string(size) + " bytes; at most 64 MiB can be read");
  }
  const ByteView records = decompressor.decompress(*compression, compressed, static_cast<std::size_t>(size));
  if (records.size() != size) return bad_input("the chunk is damaged: it cannot be decompressed");
  if (crc != 0 && crc != crc32(0, records)) return bad_input("the chunk is damaged: its checksum differs");
  return McapChunk{*compression, records};
}

bool split_record(ByteView& records, Opcode& opcode, ByteView& body) {
  ByteReader reader(records);
  opcode = static_cast<Opcode>(reader.number<std::uint8_t>());
  body = reader.consume(reader.number<std::uint64_t>());
  records = reader.rest();
  return reader.good();
}

Result<McapMessage> parse_message(ByteView body) {
  ByteReader reader(body);
  McapMessage message;
  message.channel = reader.number<std::uint16_t>();
  message.sequence = reader.number<std::uint32_t>();
  message.log_time = reader.number<std::uint64_t>();
  message.publish_time = reader.number<std::uint64_t>();
  message.data = reader.rest();
  if (!reader.good()) return bad_input("the message is shorter than its fields");
  return message;
}

Result<McapAttachment> parse_attachment(ByteView body) {
  ByteReader reader(body);
  static_cast<void>(reader.number<std::uint64_t>());  // log time
  static_cast<void>(reader.number<std::uint64_t>());  // create time
  McapAttachment attachment;
  attachment.name = reader.text();
  attachment.media_type = reader.text();
  const ByteView data = reader.consume(reader.number<std::uint64_t>());
  attachment.data.assign(data.begin(), data.end());
  const std::size_t checked_bytes = body.size() - reader.rest().size();
  const auto crc = reader.number<std::uint32_t>();
  if (!reader.good()) return bad_input("the attachment is shorter than its fields say");
  if (crc != 0 && crc != crc32(0, body.first(checked_bytes))) {
    return bad_input("the attachment is damaged: its checksum differs");
  }
  return attachment;
}

Result<McapMetadata> parse_metadata(ByteView body) {
  ByteReader reader(body);
  const std::string_view name = reader.text();
  std::optional<std::map<std::string, std::string>> values = parse_map(reader);
  if (!values) return bad_input("the metadata are shorter than their fields say");
  return McapMetadata{std::string(name), *std::move(values)};
}

/// Channels are few; what would fill the memory is none.
bool ChannelTable::has_room_for(std::size_t bytes) {
  constexpr std::size_t kMaxBytes = std::size_t{64} << 20U;
  constexpr std::size_t kEntryBytes = 512;
  bytes_ += bytes + kEntryBytes;
  return bytes_ <= kMaxBytes;
}

Status ChannelTable::add_schema(ByteView body) {
  ByteReader reader(body);
  const auto id = reader.number<std::uint16_t>();
  if (reader.good() && schemas_.contains(id)) return Done{};
  McapChannel schema;
  schema.schema_name = reader.text();
  schema.schema_encoding = reader.text();
  schema.schema = reader.text();
  if (!reader.good() || id == 0) return bad_input("the schema is shorter than its fields say, or has the number 0");
  if (!has_room_for(body.size())) return bad_input("there are more than 64 MiB of channels and schemas");
  schemas_.emplace(id, std::move(schema));
  return Done{};
}

Status ChannelTable::add_channel(ByteView body) {
  ByteReader reader(body);
  const auto id = reader.number<std::uint16_t>();
  if (reader.good() && channels_.contains(id)) return Done{};
  const auto schema_id = reader.number<std::uint16_t>();
  const auto schema = schemas_.find(schema_id);
  if (reader.good() && schema_id != 0 && schema == schemas_.end()) {
    return bad_input("the channel has the schema " + std::to_string(schema_id) + ", which is not there");
  }
  McapChannel channel = schema == schemas_.end() ? McapChannel{} : schema->second;
  channel.topic = reader.text();
  channel.encoding = reader.text();
  if (!parse_map(reader)) return bad_input("the channel is shorter than its fields say");
  if (!has_room_for(body.size() + channel.schema.size())) {
    return bad_input("there are more than 64 MiB of channels and schemas");
  }
  channels_.emplace(id, std::move(channel));
  return Done{};
}

}  // namespace dermis::bytes::recordings
