// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <mutex>
#include <optional>
#include <utility>

#include "bytes/recordings/compression.hpp"
#include "bytes/recordings/growing_file.hpp"
#include "bytes/recordings/mcap_batch.hpp"
#include "bytes/recordings/mcap_bytes.hpp"
#include "bytes/recordings/mcap_summary.hpp"
#include "dermis/bytes/recordings/mcap.hpp"

namespace dermis::bytes::recordings {

struct McapWriter::State {
  State(GrowingFile growing_file, McapCompression chunk_compression)
      : file(std::move(growing_file)),
        compression(can_compress(chunk_compression) ? chunk_compression : McapCompression::none),
        compressor(compression),
        summary(file.place_beside()) {}

  BatchBuilder added;  ///< Used by the thread that adds.

  std::mutex mutex;  ///< Of the batches between the threads.
  std::vector<Batch> sealed;
  std::vector<Batch> spare;

  // Used by the thread that writes.
  Batch writing;
  GrowingFile file;
  McapCompression compression;
  Compressor compressor;
  std::optional<Error> first_error;
  Bytes pending;  ///< Whole records that are not yet in the file.
  McapSummary summary;

  [[nodiscard]] std::uint64_t place() const { return file.size() + pending.size(); }
  void seal();
  [[nodiscard]] bool next_sealed();
  void write(const Batch& batch);
  void append_placed_indexes(const Batch& batch);
  void end_chunk(const Batch& batch);
  void append_message_indexes(const Batch& batch, Bytes& places);
  void note(const Status& status);
  [[nodiscard]] Status try_end();
  void append_end();
  [[nodiscard]] Status status() const;
};

/// Added data now wait to be written.
void McapWriter::State::seal() {
  Batch& open = added.batch();
  if (open.is_empty()) return;
  const std::scoped_lock lock(mutex);
  sealed.push_back(std::move(open));
  if (spare.empty()) {
    open = sealed.back().empty_like();
  } else {
    open = std::move(spare.back());
    spare.pop_back();
  }
}

/// The next batch to be written, in the place of the last; returns false where none waits.
bool McapWriter::State::next_sealed() {
  const std::scoped_lock lock(mutex);
  if (sealed.empty()) return false;
  writing.clear();
  if (writing.chunk.capacity() > 0) spare.push_back(std::move(writing));
  writing = std::move(sealed.front());
  sealed.erase(sealed.begin());
  return true;
}

/// Appends the chunk and its indexes to the pending records and to the summary.
void McapWriter::State::end_chunk(const Batch& batch) {
  const std::uint64_t chunk_place = place();
  const std::size_t compressed_bytes = append_chunk(pending, batch, compression, compressor);
  const std::uint64_t chunk_end = place();
  Bytes& index = summary.chunk_index;
  const Record record(index, Opcode::chunk_index);
  append_number(index, batch.first_time);
  append_number(index, batch.last_time);
  append_number(index, chunk_place);
  append_number(index, chunk_end - chunk_place);
  append_message_indexes(batch, index);
  append_number(index, place() - chunk_end);
  append_text(index, to_string(compression));
  append_number(index, std::uint64_t{compressed_bytes});
  append_number(index, std::uint64_t{batch.chunk.size()});
}

void McapWriter::State::append_message_indexes(const Batch& batch, Bytes& places) {
  const LengthBefore<std::uint32_t> length(places);
  for (std::size_t i = 0; i < batch.indexes.size(); ++i) {
    const Bytes& entries = batch.indexes[i];
    if (entries.empty()) continue;
    const auto id = static_cast<std::uint16_t>(i + 1);
    append_number(places, id);
    append_number(places, place());
    const Record record(pending, Opcode::message_index);
    append_number(pending, id);
    append_number(pending, static_cast<std::uint32_t>(entries.size()));
    append_bytes(pending, entries);
  }
}

void McapWriter::State::append_placed_indexes(const Batch& batch) {
  for (const PlacedRecord& placed : batch.placed) {
    const Record record(summary.records, placed.opcode);
    append_number(summary.records, place() + placed.offset);
    append_number(summary.records, std::uint64_t{placed.bytes});
    append_bytes(summary.records, placed.rest);
  }
}

/// Whole records go to the file, or none.
void McapWriter::State::write(const Batch& batch) {
  if (first_error) return;
  append_placed_indexes(batch);
  append_bytes(pending, batch.records);
  append_bytes(summary.records, batch.declarations);
  if (!batch.chunk.empty()) end_chunk(batch);
  note(file.append(pending));
  if (first_error) {
    file.cut_back();
    summary.drop_batch();
  } else {
    note(summary.keep_batch(pending));
  }
  pending.clear();
}

void McapWriter::State::note(const Status& status) {
  if (!status && !first_error) first_error = status.error();
}

/// Whether the end of the file has room.
Status McapWriter::State::try_end() {
  Status tried = summary.append_end(file);
  file.go_back_to(summary.file_bytes());
  file.cut_back();
  return tried;
}

/// Where the disk is full, the end of a file that others see takes the room of its last chunks.
void McapWriter::State::append_end() {
  Status ended = summary.append_end(file);
  if (ended) return;
  note(ended);
  if (file.is_full() && file.has_appeared() && summary.has_batches()) {
    ended = summary.cut_batches(file.room());
    file.go_back_to(summary.file_bytes());
    if (ended) ended = summary.append_end(file);
  }
  if (!ended) file.go_back_to(summary.file_bytes());
  file.cut_back();
}

Status McapWriter::State::status() const {
  if (first_error) return *first_error;
  return Done{};
}

McapWriter::McapWriter(std::unique_ptr<State> state) : state_(std::move(state)) {}

McapWriter::~McapWriter() = default;

Result<std::unique_ptr<McapWriter>> McapWriter::create(const std::string& path, McapCompression compression) {
  Result<GrowingFile> file = GrowingFile::create(path);
  if (!file) return file.error();
  auto state = std::make_unique<State>(*std::move(file), compression);
  state->added.begin_file();
  return std::unique_ptr<McapWriter>(new McapWriter(std::move(state)));
}

std::uint16_t McapWriter::add_channel(const McapChannel& channel) {
  return state_->added.add_channel(channel);
}

void McapWriter::add_attachment(const McapAttachment& attachment) {
  state_->added.add_attachment(attachment);
}

void McapWriter::add_metadata(const McapMetadata& metadata) {
  state_->added.add_metadata(metadata);
}

void McapWriter::add_message(const McapMessage& message) {
  state_->added.add_message(message);
}

std::size_t McapWriter::chunk_bytes() const noexcept {
  return state_->added.batch().chunk.size();
}

Status McapWriter::close_chunk() {
  seal_chunk();
  while (state_->next_sealed()) state_->write(state_->writing);
  return state_->status();
}

void McapWriter::seal_chunk() {
  state_->seal();
}

Status McapWriter::write_sealed() {
  if (state_->next_sealed()) state_->write(state_->writing);
  return state_->status();
}

/// A file appears only where its end has room: a disk that is full from the beginning replaces nothing.
Status McapWriter::appear() {
  const bool is_first = !state_->first_error && !state_->file.has_appeared();
  if (is_first) state_->note(state_->try_end());
  if (!state_->first_error) state_->note(state_->file.appear());
  return state_->status();
}

Status McapWriter::synchronise() {
  return state_->file.synchronise();
}

Status McapWriter::finish() {
  static_cast<void>(close_chunk());
  state_->append_end();
  const bool nothing_to_keep = state_->first_error && !state_->file.has_appeared();
  if (nothing_to_keep) return state_->status();
  state_->note(state_->file.synchronise());
  state_->note(state_->file.appear());
  state_->note(state_->file.close());
  return state_->status();
}

}  // namespace dermis::bytes::recordings
