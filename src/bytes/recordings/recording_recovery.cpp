// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <algorithm>
#include <filesystem>
#include <utility>

#include "bytes/recordings/mcap_scanner.hpp"
#include "bytes/recordings/recording_counts.hpp"
#include "bytes/recordings/recording_description.hpp"
#include "bytes/recordings/recording_format.hpp"
#include "dermis/bytes/files/input.hpp"
#include "dermis/bytes/files/text.hpp"
#include "dermis/bytes/recordings/recording.hpp"

namespace dermis::bytes::recordings {
namespace {

/// Whether bytes may begin a chunk: an opcode, a length, and a compression with a name.
bool may_be_chunk(ByteView bytes) {
  constexpr std::uint64_t kFieldsBytes = 8 + 8 + 8 + 4 + 4 + 8;  // without the name of the compression
  ByteReader reader(bytes);
  const auto opcode = reader.number<std::uint8_t>();
  const auto length = reader.number<std::uint64_t>();
  static_cast<void>(reader.consume(8 + 8));  // times
  const auto size = reader.number<std::uint64_t>();
  static_cast<void>(reader.number<std::uint32_t>());  // crc
  const std::string_view name = reader.text();
  const auto records_length = reader.number<std::uint64_t>();
  return reader.good() && opcode == static_cast<std::uint8_t>(Opcode::chunk) && size <= kMaxChunkBytes &&
         length >= kFieldsBytes && length - kFieldsBytes == name.size() + records_length;
}

/// Bytes that are read or made to see whether a record is whole.
std::uint64_t work_of(const McapRecord& record) {
  if (record.opcode != Opcode::chunk) return record.bytes;
  ByteReader reader(record.body);
  static_cast<void>(reader.consume(8 + 8));  // times
  const auto size = reader.number<std::uint64_t>();
  return record.bytes + (size <= kMaxChunkBytes ? size : 0);
}

/// Goes through a file that may be cut or damaged, and writes what is whole.
class RecoveryRun {
 public:
  RecoveryRun(McapScanner scanner, std::unique_ptr<McapWriter> writer)
      : scanner_(std::move(scanner)), writer_(std::move(writer)) {}

  [[nodiscard]] Result<Recovery> run();

 private:
  void add_totals();
  [[nodiscard]] Status read_records();
  [[nodiscard]] bool keep(const McapRecord& record);
  [[nodiscard]] bool recover_chunk(ByteView body);
  [[nodiscard]] bool recover_message(ByteView body);
  [[nodiscard]] bool recover_message_index(ByteView body);
  [[nodiscard]] bool recover_attachment(ByteView body);
  [[nodiscard]] bool recover_metadata(ByteView body);
  [[nodiscard]] Status find_chunk();
  [[nodiscard]] Result<bool> holds_chunk(std::uint64_t place);
  [[nodiscard]] bool may_search() const;

  McapScanner scanner_;
  std::unique_ptr<McapWriter> writer_;
  Decompressor decompressor_;
  ChannelTable table_;
  std::map<std::uint16_t, std::uint16_t> written_channels_;  ///< By the numbers they have in the file.
  RecordingCounts counts_;
  std::map<std::string, std::string> names_;  ///< Names of the arrays, by the folders of their topics.
  bool last_chunk_was_damaged_ = false;
  std::uint64_t kept_end_ = 0;      ///< End of the last record that was kept.
  std::uint64_t searched_end_ = 0;  ///< No chunk begins before that has not been tried.
  std::uint64_t kept_bytes_ = 0;    ///< Of all records that were kept.
  std::uint64_t data_end_ = 0;
  std::uint64_t work_ = 0;  ///< Bytes that were read in vain, or tried as chunks.
  std::string first_loss_;  ///< The problem of the first damaged chunk.
  Recovery recovery_;
};

Result<Recovery> RecoveryRun::run() {
  const Result<std::optional<McapScanner::Footer>> footer = scanner_.footer();
  if (!footer) return footer.error();
  recovery_.was_complete = footer->has_value();
  kept_end_ = kept_bytes_ = scanner_.place();
  if (const Status read = read_records(); !read) return read.error();
  recovery_.lost_bytes = data_end_ - kept_bytes_;
  if (recovery_.messages == 0 && recovery_.lost_bytes > 0) {
    return failed(scanner_.name() + ": nothing can be recovered" + first_loss_);
  }
  add_totals();
  if (const Status finished = writer_->finish(); !finished) return finished.error();
  return recovery_;
}

/// As the recording would have had them at its end.
void RecoveryRun::add_totals() {
  const auto add = [this](const FrameCounts& counts, std::map<std::string, std::string> values) {
    values["frames"] = std::to_string(counts.frames);
    values["lost"] = std::to_string(counts.lost);
    writer_->add_metadata({kTotalsMetadata, std::move(values)});
  };
  recovery_.frames = counts_.first().frames;
  if (names_.size() == 1) add(counts_.first(), {});
  if (names_.size() < 2) return;
  recovery_.frames = 0;
  for (const auto& [folder, name] : names_) {
    const FrameCounts counts = counts_.in_folder(folder);
    add(counts, {{"name", name}});
    recovery_.frames += counts.frames;
  }
}

/// All records up to the end of the data; what is no record is searched for the next whole chunk.
Status RecoveryRun::read_records() {
  constexpr std::size_t kChunkBytes = std::size_t{1} << 20U;  // of messages that are in no chunk
  McapRecord record;
  while (true) {
    data_end_ = scanner_.place();
    const Result<McapScanner::Step> step = scanner_.next(record);
    if (!step) return step.error();
    if (*step == McapScanner::Step::end) return Done{};
    const bool is_known = *step == McapScanner::Step::record && record.opcode <= Opcode::data_end;
    if (!is_known) {
      if (Status found = find_chunk(); !found) return found;
      continue;
    }
    if (record.opcode == Opcode::data_end) return Done{};
    const bool is_kept = !record.is_left_out && keep(record);
    if (is_kept) {
      kept_end_ = scanner_.place();
      kept_bytes_ += record.bytes;
    } else {
      work_ += work_of(record);
    }
    if (record.opcode == Opcode::chunk || writer_->chunk_bytes() >= kChunkBytes) {
      if (Status closed = writer_->close_chunk(); !closed) return closed;
    }
  }
}

/// Returns whether the record is whole.
bool RecoveryRun::keep(const McapRecord& record) {
  switch (record.opcode) {
    case Opcode::schema: return table_.add_schema(record.body).has_value();
    case Opcode::channel: return table_.add_channel(record.body).has_value();
    case Opcode::message: return recover_message(record.body);
    case Opcode::chunk:
      last_chunk_was_damaged_ = !recover_chunk(record.body);
      if (last_chunk_was_damaged_) ++recovery_.damaged_chunks;
      return !last_chunk_was_damaged_;
    case Opcode::message_index: return recover_message_index(record.body);
    case Opcode::attachment: return recover_attachment(record.body);
    case Opcode::metadata: return recover_metadata(record.body);
    default: return true;
  }
}

bool RecoveryRun::recover_chunk(ByteView body) {
  const Result<McapChunk> chunk = parse_chunk(body, decompressor_);
  if (!chunk) {
    if (first_loss_.empty()) first_loss_ = ": " + chunk.error().message;
    return false;
  }
  ByteView records = chunk->records;
  bool is_whole = true;
  while (is_whole && !records.empty()) {
    Opcode opcode{};
    ByteView record;
    is_whole = split_record(records, opcode, record);
    if (!is_whole) break;
    if (opcode == Opcode::schema) is_whole = table_.add_schema(record).has_value();
    if (opcode == Opcode::channel) is_whole = table_.add_channel(record).has_value();
    if (opcode == Opcode::message) is_whole = recover_message(record);
  }
  return is_whole;
}

bool RecoveryRun::recover_message(ByteView body) {
  Result<McapMessage> message = parse_message(body);
  if (!message) return false;
  const auto channel = table_.channels().find(message->channel);
  if (channel == table_.channels().end()) return false;
  const auto written = written_channels_.find(message->channel);
  counts_.count(*message, channel->second);
  ++recovery_.messages;
  message->channel = written != written_channels_.end()
                         ? written->second
                         : (written_channels_[message->channel] = writer_->add_channel(channel->second));
  writer_->add_message(*message);
  return true;
}

/// It counts the messages of a damaged chunk.
bool RecoveryRun::recover_message_index(ByteView body) {
  constexpr std::size_t kEntryBytes = 16;
  ByteReader reader(body);
  static_cast<void>(reader.number<std::uint16_t>());  // channel
  const ByteView entries = reader.consume(reader.number<std::uint32_t>());
  if (last_chunk_was_damaged_) recovery_.lost_messages += entries.size() / kEntryBytes;
  return reader.good() && !last_chunk_was_damaged_;
}

bool RecoveryRun::recover_attachment(ByteView body) {
  const Result<McapAttachment> attachment = parse_attachment(body);
  if (attachment) writer_->add_attachment(*attachment);
  return attachment.has_value();
}

bool RecoveryRun::recover_metadata(ByteView body) {
  const Result<McapMetadata> metadata = parse_metadata(body);
  if (!metadata) return false;
  if (metadata->name == kRecordingMetadata) {
    const std::string name = value_of(metadata->values, "name");
    names_.emplace('/' + topic_part(name) + '/', name);
  }
  if (metadata->name != kTotalsMetadata) writer_->add_metadata(*metadata);
  return true;
}

/// Places that look like chunks may overlap: a file made for it would keep a search busy for days. No damage comes
/// near.
bool RecoveryRun::may_search() const {
  constexpr std::uint64_t kTimesOfFile = 64;
  constexpr std::uint64_t kWorkOfAnyFile = std::uint64_t{256} << 20U;
  return work_ <= kWorkOfAnyFile + kTimesOfFile * scanner_.size();
}

/// Goes to the next chunk behind what was kept, or to the end of the file.
Status RecoveryRun::find_chunk() {
  constexpr std::size_t kMaxWindowBytes = std::size_t{1} << 20U;
  constexpr std::size_t kLongestBeginning = kRecordHeaderBytes + 8 + 8 + 8 + 4 + 4 + 4 + 8;
  std::uint64_t place = std::max(kept_end_, searched_end_);
  Bytes window;
  std::size_t window_bytes = 4096;
  while (place < scanner_.size()) {
    const Result<ByteView> bytes = scanner_.read(place, window_bytes + kLongestBeginning);
    if (!bytes) return bytes.error();
    window.assign(bytes->begin(), bytes->end());
    const std::size_t candidates = std::min(window.size(), window_bytes);
    for (std::size_t i = 0; i < candidates && may_search(); ++i) {
      if (!may_be_chunk(ByteView(window).subspan(i))) continue;
      const Result<bool> is_chunk = holds_chunk(place + i);
      if (!is_chunk) return is_chunk.error();
      if (*is_chunk) return Done{};
    }
    if (!may_search()) break;
    place += candidates;
    window_bytes = std::min(2 * window_bytes, kMaxWindowBytes);
  }
  scanner_.go_to(scanner_.size());
  return Done{};
}

/// Goes to the place, where a whole chunk is there.
Result<bool> RecoveryRun::holds_chunk(std::uint64_t place) {
  McapRecord record;
  scanner_.go_to(place);
  const Result<McapScanner::Step> step = scanner_.next(record);
  if (!step) return step.error();
  if (*step != McapScanner::Step::record || record.is_left_out) return false;
  work_ += work_of(record);
  if (!parse_chunk(record.body, decompressor_)) return false;
  scanner_.go_to(place);
  searched_end_ = place + 1;
  return true;
}

}  // namespace

Result<Recovery> recover_recording(const std::string& in, const std::string& out) {
  std::error_code ignored;
  if (std::filesystem::equivalent(in, out, ignored)) {
    return bad_input(files::in_quotes(out) + " is the file that is to be recovered; name another one");
  }
  Result<std::unique_ptr<std::istream>> stream = files::open_input(in);
  if (!stream) return stream.error();
  return recover_recording(*std::move(stream), in, out);
}

Result<Recovery> recover_recording(std::unique_ptr<std::istream> in, const std::string& name, const std::string& out) {
  Result<McapScanner> scanner = McapScanner::open(std::move(in), name);
  if (!scanner) return scanner.error();
  Result<std::unique_ptr<McapWriter>> writer = McapWriter::create(out, McapCompression::lz4);
  if (!writer) return writer.error();
  return RecoveryRun(*std::move(scanner), *std::move(writer)).run();
}

}  // namespace dermis::bytes::recordings
