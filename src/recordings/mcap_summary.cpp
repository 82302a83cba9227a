// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "recordings/mcap_summary.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <map>

#include "recordings/crc32.hpp"
#include "recordings/mcap_scanner.hpp"

namespace dermis::recordings {
namespace {

/// What the records of a summary tell.
struct Statistics {
  explicit Statistics(ByteView records);
  void add_messages(ByteReader chunk_index);
  void append_to(Bytes& bytes);

  std::map<Opcode, std::uint32_t> records_of;
  std::map<std::uint16_t, std::uint64_t> messages_of;  ///< By channel.
  std::uint64_t messages = 0;
  std::uint64_t first_time = std::numeric_limits<std::uint64_t>::max();
  std::uint64_t last_time = 0;
};

Statistics::Statistics(ByteView records) {
  Opcode opcode{};
  ByteView body;
  while (!records.empty() && take_record(records, opcode, body)) {
    ++records_of[opcode];
    if (opcode == Opcode::chunk_index) add_messages(ByteReader(body));
  }
}

void Statistics::add_messages(ByteReader chunk_index) {
  constexpr std::size_t kPlaceBytes = 2 + 8;
  constexpr std::uint64_t kBytesBeforeEntries = kRecordHeaderBytes + 2 + 4;
  constexpr std::uint64_t kEntryBytes = 8 + 8;
  first_time = std::min(first_time, chunk_index.number<std::uint64_t>());
  last_time = std::max(last_time, chunk_index.number<std::uint64_t>());
  const auto chunk_place = chunk_index.number<std::uint64_t>();
  const std::uint64_t chunk_end = chunk_place + chunk_index.number<std::uint64_t>();
  ByteView places = chunk_index.consume(chunk_index.number<std::uint32_t>());
  // Backwards: the index of a channel ends where that of the next one begins.
  std::uint64_t end = chunk_end + chunk_index.number<std::uint64_t>();
  for (; !places.empty(); places = places.first(places.size() - kPlaceBytes)) {
    ByteReader last(places.last(kPlaceBytes));
    const auto channel = last.number<std::uint16_t>();
    const auto place = last.number<std::uint64_t>();
    const std::uint64_t entries = (end - place - kBytesBeforeEntries) / kEntryBytes;
    messages_of[channel] += entries;
    messages += entries;
    end = place;
  }
}

void Statistics::append_to(Bytes& bytes) {
  constexpr std::uint32_t kEntryBytes = 2 + 8;
  const std::uint32_t channels = records_of[Opcode::channel];
  const Record record(bytes, Opcode::statistics);
  append_number(bytes, messages);
  append_number(bytes, static_cast<std::uint16_t>(records_of[Opcode::schema]));
  append_number(bytes, channels);
  append_number(bytes, records_of[Opcode::attachment_index]);
  append_number(bytes, records_of[Opcode::metadata_index]);
  append_number(bytes, records_of[Opcode::chunk_index]);
  append_number(bytes, messages == 0 ? 0 : first_time);
  append_number(bytes, last_time);
  append_number(bytes, kEntryBytes * channels);
  for (std::uint32_t i = 1; i <= channels; ++i) {
    const auto channel = static_cast<std::uint16_t>(i);
    append_number(bytes, channel);
    append_number(bytes, messages_of[channel]);
  }
}

/// Those of the opcode.
void append_records(ByteView records, Opcode wanted, Bytes& bytes) {
  Opcode opcode{};
  ByteView body;
  while (!records.empty()) {
    const ByteView all = records;
    if (!take_record(records, opcode, body)) return;
    if (opcode == wanted) append_bytes(bytes, all.first(all.size() - records.size()));
  }
}

/// The records by opcode, behind bytes that begin at `place` of the file; returns the offsets of the groups.
Bytes append_groups(ByteView records, std::uint64_t place, Bytes& bytes) {
  Bytes offsets;
  for (const Opcode opcode : {Opcode::schema, Opcode::channel, Opcode::statistics, Opcode::chunk_index,
                              Opcode::attachment_index, Opcode::metadata_index}) {
    const std::size_t begin = bytes.size();
    if (opcode == Opcode::statistics) {
      Statistics(records).append_to(bytes);
    } else {
      append_records(records, opcode, bytes);
    }
    if (bytes.size() == begin) continue;
    const Record offset(offsets, Opcode::summary_offset);
    append_number(offsets, static_cast<std::uint8_t>(opcode));
    append_number(offsets, place + begin);
    append_number(offsets, std::uint64_t{bytes.size() - begin});
  }
  return offsets;
}

/// With the checksum of the summary, which begins at `checked_begin` of the bytes.
void append_footer(std::uint64_t summary_place, std::uint64_t offsets_place, std::size_t checked_begin, Bytes& bytes) {
  const Record footer(bytes, Opcode::footer);
  append_number(bytes, summary_place);
  append_number(bytes, offsets_place);
  // The checksum counts the length of the footer, which is not yet there.
  const std::uint64_t footer_length = kFooterBytes;
  std::memcpy(bytes.data() + bytes.size() - 24, &footer_length, sizeof(footer_length));
  append_number(bytes, crc32(0, ByteView(bytes).subspan(checked_begin)));
}

}  // namespace

void McapSummary::keep_batch(ByteView bytes) {
  const Written before = written();
  batches.push_back({before.file_bytes + bytes.size(), records.size(), crc32(before.data_crc, bytes)});
}

void McapSummary::drop_batch() {
  records.resize(written().record_bytes);
}

void McapSummary::cut_batches(std::uint64_t room) {
  const std::uint64_t end_without_records = end_of_file().size() - records.size();
  const auto fits = [&](const Written& batch) {
    return batch.file_bytes + batch.record_bytes + end_without_records <= room;
  };
  while (batches.size() > 1 && !fits(batches.back())) batches.pop_back();
  drop_batch();
}

McapSummary::Written McapSummary::written() const {
  return batches.empty() ? Written{} : batches.back();
}

Bytes McapSummary::end_of_file() const {
  const std::uint64_t place = written().file_bytes;
  Bytes bytes;
  {
    const Record data_end(bytes, Opcode::data_end);
    append_number(bytes, written().data_crc);
  }
  const std::size_t summary_begin = bytes.size();
  const Bytes offsets = append_groups(records, place, bytes);
  const std::uint64_t offsets_place = place + bytes.size();
  append_bytes(bytes, offsets);
  append_footer(place + summary_begin, offsets_place, summary_begin, bytes);
  append_characters(bytes, kMcapMagic);
  return bytes;
}

}  // namespace dermis::recordings
