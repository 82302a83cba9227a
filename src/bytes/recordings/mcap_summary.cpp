// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/recordings/mcap_summary.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <map>

#include "bytes/recordings/crc32.hpp"
#include "bytes/recordings/mcap_scanner.hpp"

namespace dermis::bytes::recordings {
namespace {

constexpr std::size_t kBlockBytes = std::size_t{64} << 10U;  ///< Size of spilled bytes that are read again.

/// The statistics of a summary's records.
class Statistics {
 public:
  explicit Statistics(ByteView records);
  [[nodiscard]] Status add(const SpilledBytes& chunk_indexes);
  void append_to(Bytes& bytes) const;

 private:
  [[nodiscard]] std::size_t add_whole_records(ByteView chunk_indexes);
  void add_messages(ByteReader chunk_index);
  [[nodiscard]] std::uint32_t count_of(Opcode opcode) const;

  std::map<Opcode, std::uint32_t> records_of_;
  std::map<std::uint16_t, std::uint64_t> messages_of_;  ///< By channel.
  std::uint64_t messages_ = 0;
  std::uint64_t first_time_ = std::numeric_limits<std::uint64_t>::max();
  std::uint64_t last_time_ = 0;
};

Statistics::Statistics(ByteView records) {
  Opcode opcode{};
  ByteView body;
  while (!records.empty() && split_record(records, opcode, body)) ++records_of_[opcode];
}

Status Statistics::add(const SpilledBytes& chunk_indexes) {
  Bytes block(kBlockBytes);
  for (std::uint64_t place = 0; place < chunk_indexes.size();) {
    const std::uint64_t rest = chunk_indexes.size() - place;
    const std::span<std::uint8_t> bytes = std::span(block).first(std::min<std::uint64_t>(block.size(), rest));
    if (Status read = chunk_indexes.read(place, bytes); !read) return read;
    const std::size_t taken = add_whole_records(bytes);
    if (taken == 0 && bytes.size() == rest) return failed("the index of the recording cannot be read back");
    if (taken == 0) block.resize(2 * block.size());
    place += taken;
  }
  return Done{};
}

/// Returns how many bytes they have.
std::size_t Statistics::add_whole_records(ByteView chunk_indexes) {
  ByteView rest = chunk_indexes;
  Opcode opcode{};
  ByteView body;
  for (ByteView next = rest; !next.empty() && split_record(next, opcode, body); rest = next) {
    ++records_of_[opcode];
    add_messages(ByteReader(body));
  }
  return chunk_indexes.size() - rest.size();
}

void Statistics::add_messages(ByteReader chunk_index) {
  constexpr std::size_t kPlaceBytes = 2 + 8;
  constexpr std::uint64_t kBytesBeforeEntries = kRecordHeaderBytes + 2 + 4;
  constexpr std::uint64_t kEntryBytes = 8 + 8;
  first_time_ = std::min(first_time_, chunk_index.number<std::uint64_t>());
  last_time_ = std::max(last_time_, chunk_index.number<std::uint64_t>());
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
    messages_of_[channel] += entries;
    messages_ += entries;
    end = place;
  }
}

std::uint32_t Statistics::count_of(Opcode opcode) const {
  const auto found = records_of_.find(opcode);
  return found == records_of_.end() ? 0 : found->second;
}

void Statistics::append_to(Bytes& bytes) const {
  constexpr std::uint32_t kEntryBytes = 2 + 8;
  const std::uint32_t channels = count_of(Opcode::channel);
  const Record record(bytes, Opcode::statistics);
  append_number(bytes, messages_);
  append_number(bytes, static_cast<std::uint16_t>(count_of(Opcode::schema)));
  append_number(bytes, channels);
  append_number(bytes, count_of(Opcode::attachment_index));
  append_number(bytes, count_of(Opcode::metadata_index));
  append_number(bytes, count_of(Opcode::chunk_index));
  append_number(bytes, messages_ == 0 ? 0 : first_time_);
  append_number(bytes, last_time_);
  append_number(bytes, kEntryBytes * channels);
  for (std::uint32_t i = 1; i <= channels; ++i) {
    const auto channel = static_cast<std::uint16_t>(i);
    const auto of_channel = messages_of_.find(channel);
    append_number(bytes, channel);
    append_number(bytes, of_channel == messages_of_.end() ? 0 : of_channel->second);
  }
}

template <typename T>
std::span<std::uint8_t> bytes_of(T& value) {
  return {reinterpret_cast<std::uint8_t*>(&value), sizeof(T)};
}

/// Those of the opcode.
void append_records(ByteView records, Opcode wanted, Bytes& bytes) {
  Opcode opcode{};
  ByteView body;
  while (!records.empty()) {
    const ByteView all = records;
    if (!split_record(records, opcode, body)) return;
    if (opcode == wanted) append_bytes(bytes, all.first(all.size() - records.size()));
  }
}

/// The end of a file, around the indexes of its chunks.
struct EndOfFile {
  Bytes before;                   ///< Data end, and the summary up to the indexes.
  std::size_t summary_begin = 0;  ///< In `before`.
  Bytes after;                    ///< The rest, up to the checksum of the footer.
  static constexpr std::size_t kLastBytes = sizeof(std::uint32_t) + kMcapMagic.size();

  [[nodiscard]] std::size_t size() const { return before.size() + after.size() + kLastBytes; }
};

void append_offset(Opcode opcode, std::uint64_t begin, std::uint64_t end, Bytes& offsets) {
  if (begin == end) return;
  const Record offset(offsets, Opcode::summary_offset);
  append_number(offsets, static_cast<std::uint8_t>(opcode));
  append_number(offsets, begin);
  append_number(offsets, end - begin);
}

/// The end behind the data up to `place`.
EndOfFile end_of_file(std::uint64_t place, std::uint32_t data_crc, ByteView records, const Statistics& statistics,
                      std::uint64_t index_bytes) {
  EndOfFile end;
  {
    const Record data_end(end.before, Opcode::data_end);
    append_number(end.before, data_crc);
  }
  end.summary_begin = end.before.size();
  Bytes offsets;
  for (const Opcode opcode : {Opcode::schema, Opcode::channel, Opcode::statistics}) {
    const std::size_t begin = end.before.size();
    if (opcode == Opcode::statistics) {
      statistics.append_to(end.before);
    } else {
      append_records(records, opcode, end.before);
    }
    append_offset(opcode, place + begin, place + end.before.size(), offsets);
  }
  const std::uint64_t index_place = place + end.before.size();
  const std::uint64_t after_place = index_place + index_bytes;
  append_offset(Opcode::chunk_index, index_place, after_place, offsets);
  for (const Opcode opcode : {Opcode::attachment_index, Opcode::metadata_index}) {
    const std::size_t begin = end.after.size();
    append_records(records, opcode, end.after);
    append_offset(opcode, after_place + begin, after_place + end.after.size(), offsets);
  }
  const std::uint64_t offsets_place = after_place + end.after.size();
  append_bytes(end.after, offsets);
  append_number(end.after, static_cast<std::uint8_t>(Opcode::footer));
  append_number(end.after, std::uint64_t{kFooterBytes});
  append_number(end.after, place + end.summary_begin);
  append_number(end.after, offsets_place);
  return end;
}

/// Returns the checksum, which was `crc` before.
Result<std::uint32_t> append_spilled(const SpilledBytes& spilled, std::uint32_t crc, GrowingFile& file) {
  Bytes block(kBlockBytes);
  for (std::uint64_t place = 0; place < spilled.size(); place += kBlockBytes) {
    block.resize(std::min<std::uint64_t>(kBlockBytes, spilled.size() - place));
    if (const Status read = spilled.read(place, block); !read) return read.error();
    if (const Status appended = file.append(block); !appended) return appended.error();
    crc = crc32(crc, block);
  }
  return crc;
}

}  // namespace

Status McapSummary::keep_batch(ByteView bytes) {
  const Status spilled = chunk_indexes_.append(chunk_index);
  last_ = {last_.file_bytes + bytes.size(), records.size(), chunk_indexes_.size(), crc32(last_.data_crc, bytes)};
  chunk_index.clear();
  const Status noted = batches_.append(bytes_of(last_));
  return spilled ? noted : spilled;
}

void McapSummary::drop_batch() {
  records.resize(last_.record_bytes);
  chunk_index.clear();
}

Status McapSummary::cut_batches(std::uint64_t room) {
  const EndOfFile end = end_of_file(0, 0, records, Statistics(records), chunk_indexes_.size());
  const std::uint64_t end_bytes = end.size() - records.size();
  const auto fits = [&] { return last_.file_bytes + last_.record_bytes + last_.index_bytes + end_bytes <= room; };
  while (batches_.size() > sizeof(Written) && !fits()) {
    batches_.cut(batches_.size() - sizeof(Written));
    if (Status read = batches_.read(batches_.size() - sizeof(Written), bytes_of(last_)); !read) return read;
  }
  chunk_indexes_.cut(last_.index_bytes);
  drop_batch();
  return Done{};
}

Status McapSummary::append_end(GrowingFile& file) const {
  Statistics statistics(records);
  if (Status counted = statistics.add(chunk_indexes_); !counted) return counted;
  EndOfFile end = end_of_file(last_.file_bytes, last_.data_crc, records, statistics, chunk_indexes_.size());
  if (Status appended = file.append(end.before); !appended) return appended;
  const std::uint32_t crc = crc32(0, ByteView(end.before).subspan(end.summary_begin));
  const Result<std::uint32_t> index_crc = append_spilled(chunk_indexes_, crc, file);
  if (!index_crc) return index_crc.error();
  append_number(end.after, crc32(*index_crc, end.after));
  append_characters(end.after, kMcapMagic);
  return file.append(end.after);
}

}  // namespace dermis::bytes::recordings
