// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <algorithm>
#include <utility>

#include "bytes/recordings/crc32.hpp"
#include "bytes/recordings/mcap_kept_records.hpp"
#include "bytes/recordings/mcap_scanner.hpp"
#include "dermis/bytes/files/input.hpp"
#include "dermis/bytes/recordings/mcap.hpp"

namespace dermis::bytes::recordings {
namespace {

constexpr const char* kMend = "; dermis info recover writes what can be read into a new file";

/// A chunk as the summary describes it.
struct ChunkPlace {
  std::uint64_t first_time;
  std::uint64_t last_time;
  std::uint64_t place;
};

bool stands_before(const ChunkPlace& a, const ChunkPlace& b) {
  return a.place < b.place;
}

}  // namespace

struct McapReader::State {
  explicit State(McapScanner file_scanner) : scanner(std::move(file_scanner)) {}

  McapScanner scanner;
  Decompressor decompressor;
  bool complete = false;
  std::optional<McapStatistics> statistics;
  ChannelTable table;
  KeptRecords kept;
  std::vector<McapCompression> compressions;

  std::uint64_t data_place = 0;           ///< Where the records begin, and
  std::optional<std::uint32_t> data_crc;  ///< the checksum of what is before.
  std::vector<ChunkPlace> chunks;         ///< Chunks of the summary, in the order to be read.
  bool goes_by_chunks = false;            ///< Else from record to record of the file.
  std::size_t next_chunk = 0;
  bool ended = false;
  std::uint64_t chunk_place = 0;
  ByteView chunk_records;  ///< What is left of the chunk.

  [[nodiscard]] Error error(std::uint64_t place, const Error& what) const {
    return scanner.error(place, what.message + kMend);
  }
  [[nodiscard]] Status read_summary();
  [[nodiscard]] Status read_summary_records(const McapScanner::Footer& footer);
  [[nodiscard]] Status sort_chunks();
  [[nodiscard]] Status read_summary_record(const McapRecord& record);
  [[nodiscard]] Status read_statistics(ByteReader reader);
  [[nodiscard]] Status read_chunk_index(ByteReader reader);
  [[nodiscard]] Status read_indexed();
  [[nodiscard]] Status keep(const McapRecord& record);
  void note(McapCompression compression);

  [[nodiscard]] Result<bool> next_record(McapRecord& record);
  [[nodiscard]] Result<bool> next_in_file(McapRecord& record);
  [[nodiscard]] Result<bool> handle(const McapRecord& record, McapMessage& message);
  [[nodiscard]] Result<bool> read_message(ByteView body, McapMessage& message) const;
  [[nodiscard]] Result<bool> next_in_chunk(McapMessage& message);
};

void McapReader::State::note(McapCompression compression) {
  if (std::find(compressions.begin(), compressions.end(), compression) == compressions.end()) {
    compressions.push_back(compression);
  }
}

Status McapReader::State::read_summary() {
  const std::uint64_t data = scanner.place();
  const Result<std::optional<McapScanner::Footer>> footer = scanner.footer();
  if (!footer) return footer.error();
  complete = footer->has_value();
  if (!complete || (*footer)->summary == 0) return Done{};
  if ((*footer)->summary < data || (*footer)->summary > (*footer)->place) {
    return scanner.error((*footer)->place, std::string("the footer points outside of the file") + kMend);
  }
  if (Status read = read_summary_records(**footer); !read) return read;
  if (Status read = read_indexed(); !read) return read;
  return sort_chunks();
}

/// By time, where they do not stand so in the file.
Status McapReader::State::sort_chunks() {
  const auto is_later = [](const ChunkPlace& a, const ChunkPlace& b) { return a.first_time > b.first_time; };
  const auto is_same = [](const ChunkPlace& a, const ChunkPlace& b) { return a.place == b.place; };
  std::sort(chunks.begin(), chunks.end(), stands_before);
  if (const auto twice = std::adjacent_find(chunks.begin(), chunks.end(), is_same); twice != chunks.end()) {
    return scanner.error(twice->place, std::string("the summary names the chunk twice") + kMend);
  }
  goes_by_chunks = std::adjacent_find(chunks.begin(), chunks.end(), is_later) != chunks.end();
  if (goes_by_chunks) {
    std::stable_sort(chunks.begin(), chunks.end(),
                     [&](const ChunkPlace& a, const ChunkPlace& b) { return is_later(b, a); });
  }
  return Done{};
}

Status McapReader::State::read_summary_records(const McapScanner::Footer& footer) {
  scanner.go_to(footer.summary, 0);
  McapRecord record;
  while (scanner.place() < footer.place) {
    const Result<McapScanner::Step> step = scanner.next(record);
    if (!step) return step.error();
    if (*step != McapScanner::Step::record || scanner.place() > footer.place) {
      return scanner.error(scanner.place(), std::string("the summary is damaged") + kMend);
    }
    if (const Status taken = read_summary_record(record); !taken) return error(record.place, taken.error());
  }
  const bool has_crc = footer.crc != 0 && scanner.crc();
  if (!has_crc || footer.crc == crc32(*scanner.crc(), footer.checked_bytes)) return Done{};
  return scanner.error(footer.place, std::string("the summary is damaged: its checksum differs") + kMend);
}

Status McapReader::State::read_summary_record(const McapRecord& record) {
  switch (record.opcode) {
    case Opcode::schema: return table.add_schema(record.body);
    case Opcode::channel: return table.add_channel(record.body);
    case Opcode::statistics: return read_statistics(ByteReader(record.body));
    case Opcode::chunk_index: return read_chunk_index(ByteReader(record.body));
    case Opcode::attachment_index:
    case Opcode::metadata_index: {
      ByteReader reader(record.body);
      const bool is_attachment = record.opcode == Opcode::attachment_index;
      kept.index.emplace_back(is_attachment ? Opcode::attachment : Opcode::metadata, reader.number<std::uint64_t>());
      if (!reader.good()) return bad_input("an index of the summary is shorter than its fields");
      return Done{};
    }
    default: return Done{};
  }
}

Status McapReader::State::read_statistics(ByteReader reader) {
  McapStatistics taken;
  taken.messages = reader.number<std::uint64_t>();
  static_cast<void>(reader.number<std::uint16_t>());  // schemas
  static_cast<void>(reader.number<std::uint32_t>());  // channels
  const std::uint64_t attachment_count = reader.number<std::uint32_t>();
  kept.count = attachment_count + reader.number<std::uint32_t>();  // and metadata
  taken.chunks = reader.number<std::uint32_t>();
  taken.first_log_time = reader.number<std::uint64_t>();
  taken.last_log_time = reader.number<std::uint64_t>();
  ByteReader counts(reader.consume(reader.number<std::uint32_t>()));
  while (counts.good() && !counts.rest().empty()) {
    const auto channel = counts.number<std::uint16_t>();
    taken.channel_messages[channel] = counts.number<std::uint64_t>();
  }
  if (!reader.good() || !counts.good()) return bad_input("the statistics are shorter than their fields");
  statistics = std::move(taken);
  return Done{};
}

Status McapReader::State::read_chunk_index(ByteReader reader) {
  ChunkPlace chunk{};
  chunk.first_time = reader.number<std::uint64_t>();
  chunk.last_time = reader.number<std::uint64_t>();
  chunk.place = reader.number<std::uint64_t>();
  static_cast<void>(reader.number<std::uint64_t>());                  // length
  static_cast<void>(reader.consume(reader.number<std::uint32_t>()));  // message indexes
  static_cast<void>(reader.number<std::uint64_t>());                  // length of message indexes
  const std::string_view name = reader.text();
  if (!reader.good()) return bad_input("the index of a chunk is shorter than its fields");
  for (const McapCompression compression : {McapCompression::none, McapCompression::lz4, McapCompression::zstd}) {
    if (name == to_string(compression)) note(compression);
  }
  chunks.push_back(chunk);
  return Done{};
}

/// Attachments and metadata by their indexes. Where these are wrong (npm's @mcap/core 2.2.2 writes wrong ones into
/// files without chunks), they are found on the way through the file.
Status McapReader::State::read_indexed() {
  std::uint64_t read_bytes = 0;
  McapRecord record;
  kept.is_complete = kept.index.size() == kept.count;
  for (const auto& [opcode, place] : kept.index) {
    if (!kept.is_complete) break;
    scanner.go_to(std::min(place, scanner.size()));
    const Result<McapScanner::Step> step = scanner.next(record);
    if (!step) return step.error();
    read_bytes += record.bytes;
    kept.is_complete = *step == McapScanner::Step::record && record.opcode == opcode && read_bytes <= scanner.size();
    const Status taken = kept.is_complete ? keep(record) : Status(Done{});
    if (!taken) return taken.error();
  }
  if (!kept.is_complete) kept.clear();
  return Done{};
}

Status McapReader::State::keep(const McapRecord& record) {
  if (const Status added = kept.add(record); !added) return error(record.place, added.error());
  return Done{};
}

/// Returns false at the end.
Result<bool> McapReader::State::next_record(McapRecord& record) {
  if (ended) return false;
  if (!goes_by_chunks) return next_in_file(record);
  if (next_chunk == chunks.size()) return false;
  const std::uint64_t place = chunks[next_chunk++].place;
  scanner.go_to(std::min(place, scanner.size()));
  const Result<McapScanner::Step> step = scanner.next(record);
  if (!step) return step.error();
  if (*step != McapScanner::Step::record || record.opcode != Opcode::chunk) {
    return scanner.error(place, std::string("the summary points to what is no chunk") + kMend);
  }
  return true;
}

Result<bool> McapReader::State::next_in_file(McapRecord& record) {
  const std::optional<std::uint32_t> crc = scanner.crc();
  const Result<McapScanner::Step> step = scanner.next(record);
  if (!step) return step.error();
  if (*step == McapScanner::Step::wrong) {
    return scanner.error(scanner.place(), std::string("here begins no record: the file is damaged") + kMend);
  }
  if (*step != McapScanner::Step::record) {
    ended = true;
    if (!complete) return false;  // an interrupted recording
    return scanner.error(scanner.place(), std::string("the record is longer than the file") + kMend);
  }
  if (record.opcode == Opcode::data_end) {
    ended = true;
    ByteReader reader(record.body);
    const auto expected = reader.number<std::uint32_t>();
    if (expected == 0 || !crc || expected == *crc) return false;
    return scanner.error(record.place, std::string("the file is damaged: the checksum of its data differs") + kMend);
  }
  if (record.opcode == Opcode::footer) {
    return scanner.error(record.place, std::string("the file ends before its data do: it is damaged") + kMend);
  }
  return true;
}

/// Returns whether the record is a message.
Result<bool> McapReader::State::handle(const McapRecord& record, McapMessage& message) {
  switch (record.opcode) {
    case Opcode::schema:
    case Opcode::channel: {
      const Status added =
          record.opcode == Opcode::schema ? table.add_schema(record.body) : table.add_channel(record.body);
      if (!added) return error(record.place, added.error());
      return false;
    }
    case Opcode::attachment:
    case Opcode::metadata:
      if (!kept.is_complete && record.place >= kept.end) {
        kept.end = record.place + record.bytes;
        if (const Status taken = keep(record); !taken) return taken.error();
      }
      return false;
    case Opcode::message:
      if (record.is_left_out) return scanner.error(record.place, "the message has more than 64 MiB");
      chunk_place = record.place;
      return read_message(record.body, message);
    case Opcode::chunk: {
      if (record.is_left_out) return scanner.error(record.place, "the chunk has more than 64 MiB");
      const Result<McapChunk> chunk = parse_chunk(record.body, decompressor);
      if (!chunk) return error(record.place, chunk.error());
      note(chunk->compression);
      chunk_place = record.place;
      chunk_records = chunk->records;
      return false;
    }
    default: return false;
  }
}

Result<bool> McapReader::State::read_message(ByteView body, McapMessage& message) const {
  const Result<McapMessage> parsed = parse_message(body);
  if (!parsed) return error(chunk_place, parsed.error());
  if (!table.channels().contains(parsed->channel)) {
    return scanner.error(chunk_place, "a message of the channel " + std::to_string(parsed->channel) +
                                          ", which is not described" + kMend);
  }
  message = *parsed;
  return true;
}

/// Returns false at the end of the chunk.
Result<bool> McapReader::State::next_in_chunk(McapMessage& message) {
  while (!chunk_records.empty()) {
    McapRecord record;
    record.place = chunk_place;
    if (!split_record(chunk_records, record.opcode, record.body)) {
      return scanner.error(chunk_place, std::string("the records of the chunk do not fill it") + kMend);
    }
    if (record.opcode == Opcode::message) return read_message(record.body, message);
    if (record.opcode != Opcode::schema && record.opcode != Opcode::channel) continue;
    if (const Result<bool> taken = handle(record, message); !taken) return taken.error();
  }
  return false;
}

McapReader::McapReader(std::unique_ptr<State> state) : state_(std::move(state)) {}

McapReader::~McapReader() = default;

Result<std::unique_ptr<McapReader>> McapReader::open(const std::string& path) {
  Result<std::unique_ptr<std::istream>> in = files::open_input(path);
  if (!in) return in.error();
  return open(*std::move(in), path);
}

Result<std::unique_ptr<McapReader>> McapReader::open(std::unique_ptr<std::istream> in, const std::string& name) {
  Result<McapScanner> scanner = McapScanner::open(std::move(in), name);
  if (!scanner) return scanner.error();
  auto state = std::make_unique<State>(*std::move(scanner));
  state->data_place = state->scanner.place();
  state->data_crc = state->scanner.crc();
  if (const Status summary = state->read_summary(); !summary) return summary.error();
  state->scanner.go_to(state->data_place, state->data_crc);
  return std::unique_ptr<McapReader>(new McapReader(std::move(state)));
}

bool McapReader::complete() const noexcept {
  return state_->complete;
}

const std::optional<McapStatistics>& McapReader::statistics() const noexcept {
  return state_->statistics;
}

Result<bool> McapReader::next(McapMessage& message) {
  while (true) {
    Result<bool> in_chunk = state_->next_in_chunk(message);
    if (!in_chunk || *in_chunk) return in_chunk;
    McapRecord record;
    Result<bool> in_file = state_->next_record(record);
    if (!in_file || !*in_file) return in_file;
    Result<bool> is_message = state_->handle(record, message);
    if (!is_message || *is_message) return is_message;
  }
}

void McapReader::read_as_written() {
  std::sort(state_->chunks.begin(), state_->chunks.end(), stands_before);
  state_->goes_by_chunks = false;
}

void McapReader::rewind() {
  state_->ended = false;
  state_->chunk_records = {};
  state_->next_chunk = 0;
  state_->scanner.go_to(state_->data_place, state_->data_crc);
}

void McapReader::seek(std::uint64_t log_time) {
  State& state = *state_;
  state.ended = false;
  state.chunk_records = {};
  state.goes_by_chunks = !state.chunks.empty();
  if (!state.goes_by_chunks) state.scanner.go_to(state.data_place, state.data_crc);
  const auto found = std::find_if(state.chunks.begin(), state.chunks.end(),
                                  [&](const ChunkPlace& chunk) { return chunk.last_time >= log_time; });
  state.next_chunk = static_cast<std::size_t>(found - state.chunks.begin());
}

const std::map<std::uint16_t, McapChannel>& McapReader::channels() const noexcept {
  return state_->table.channels();
}

const std::vector<McapAttachment>& McapReader::attachments() const noexcept {
  return state_->kept.attachments;
}

const std::vector<McapMetadata>& McapReader::metadata() const noexcept {
  return state_->kept.metadata;
}

const std::vector<McapCompression>& McapReader::compressions() const noexcept {
  return state_->compressions;
}

}  // namespace dermis::bytes::recordings
