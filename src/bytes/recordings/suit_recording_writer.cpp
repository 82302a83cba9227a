// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <cassert>
#include <cstdint>
#include <functional>
#include <map>
#include <utility>

#include "bytes/recordings/chunk_writing.hpp"
#include "bytes/recordings/recording_format.hpp"
#include "bytes/recordings/written_array.hpp"
#include "dermis/bytes/files/text.hpp"
#include "dermis/bytes/recordings/suit_recording.hpp"

namespace dermis::bytes::recordings {
namespace {

constexpr std::size_t kChunkBytes = std::size_t{1} << 20U;
constexpr std::size_t kSuitChunkBytes = std::size_t{8} << 20U;  ///< Each chunk has an index of each topic.

constexpr std::size_t kShareOfResults = 8;  ///< The part of that room in which results may wait.

/// An array with what was written of it.
struct ArrayAtWork {
  explicit ArrayAtWork(RecordedArray description) : written(std::move(description)) {}

  WrittenArray written;
  std::uint64_t lost = 0;
  std::uint32_t left_out = 0;  ///< Frames since the last one that is in the file.
};

/// A topic of messages that belong to no frame.
struct EventTopic {
  std::uint16_t channel = 0;
  std::uint32_t messages = 0;
};

Status check_topics(const std::vector<RecordedArray>& arrays) {
  for (std::size_t i = 0; i < arrays.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if (topic_part(arrays[i].name) != topic_part(arrays[k].name)) continue;
      return bad_input("the arrays " + files::in_quotes(arrays[k].name) + " and " + files::in_quotes(arrays[i].name) +
                       " of a recording would have the same topics; give one another name");
    }
  }
  return Done{};
}

}  // namespace

class SuitRecordingWriter::Implementation {
 public:
  Implementation(std::unique_ptr<McapWriter> mcap, std::vector<RecordedArray> arrays, bool live);

  [[nodiscard]] Status write(std::size_t array, const RawFrame& frame, const ForceFrame* force_frame);
  [[nodiscard]] Status write(const RecordedEvent& event);
  [[nodiscard]] Result<bool> try_write(std::size_t array, const RawFrame& frame);
  [[nodiscard]] Result<bool> try_write(const RecordedEvent& event);
  [[nodiscard]] Status commit();

 private:
  void describe(const RecordedArray& array);
  void add(const RecordedEvent& event, McapWriter& mcap);
  void add_totals(McapWriter& mcap) const;

  ChunkWriting writing_;
  std::vector<ArrayAtWork> arrays_;                              ///< Each of the thread that writes its frames.
  std::map<std::string, EventTopic, std::less<>> event_topics_;  ///< Of who adds to writing_.
};

SuitRecordingWriter::Implementation::Implementation(std::unique_ptr<McapWriter> mcap, std::vector<RecordedArray> arrays,
                                                    bool live)
    : writing_(std::move(mcap), arrays.size() == 1 ? kChunkBytes : kSuitChunkBytes, live) {
  for (RecordedArray& array : arrays) arrays_.emplace_back(std::move(array));
  for (const ArrayAtWork& array : arrays_) describe(array.written.description());
}

void SuitRecordingWriter::Implementation::describe(const RecordedArray& array) {
  McapWriter& mcap = writing_.mcap();
  mcap.add_metadata(metadata_of(array));
  const std::string name = arrays_.size() == 1 ? "" : array.name;
  const auto attach = [&](const char* of, const char* type, const std::string& data) {
    if (!data.empty()) mcap.add_attachment({attachment_name(of, name), type, data});
  };
  attach(kArrayAttachment, "application/toml", array.array_toml);
  attach(kModelAttachment, "application/octet-stream", array.model_file);
}

void SuitRecordingWriter::Implementation::add(const RecordedEvent& event, McapWriter& mcap) {
  auto topic = event_topics_.find(event.topic);
  if (topic == event_topics_.end()) {
    const std::string name(event.topic);
    const std::uint16_t channel = mcap.add_channel({name, "cdr", event.type.name, "ros2msg", event.type.definition});
    topic = event_topics_.emplace(name, EventTopic{channel}).first;
  }
  const std::uint64_t log_time = log_time_of(event.time);
  mcap.add_message({topic->second.channel, topic->second.messages++, log_time, log_time, event.message});
}

Status SuitRecordingWriter::Implementation::write(std::size_t index, const RawFrame& frame,
                                                  const ForceFrame* force_frame) {
  assert(index < arrays_.size());
  ArrayAtWork& array = arrays_[index];
  array.written.encode(frame, force_frame);
  array.lost += frame.acquisition.lost_before;
  return writing_.add([&](McapWriter& mcap) { array.written.add_to(mcap); });
}

Status SuitRecordingWriter::Implementation::write(const RecordedEvent& event) {
  return writing_.add([&](McapWriter& mcap) { add(event, mcap); });
}

Result<bool> SuitRecordingWriter::Implementation::try_write(std::size_t index, const RawFrame& frame) {
  assert(index < arrays_.size());
  ArrayAtWork& array = arrays_[index];
  if (array.left_out > 0) {
    RawFrame after_gap = frame;
    after_gap.acquisition.lost_before += array.left_out;
    array.written.encode(after_gap, nullptr);
  } else {
    array.written.encode(frame, nullptr);
  }
  Result<bool> added = writing_.try_add([&](McapWriter& mcap) { array.written.add_to(mcap); }, writing_.most_chunks());
  const bool is_left_out = added && !*added;
  array.lost += frame.acquisition.lost_before + (is_left_out ? 1 : 0);
  array.left_out = is_left_out ? array.left_out + frame.acquisition.lost_before + 1 : 0;
  return added;
}

Result<bool> SuitRecordingWriter::Implementation::try_write(const RecordedEvent& event) {
  const std::size_t most = writing_.most_chunks();
  return writing_.try_add([&](McapWriter& mcap) { add(event, mcap); },
                          event.is_of_frame ? most / kShareOfResults : 2 * most);
}

void SuitRecordingWriter::Implementation::add_totals(McapWriter& mcap) const {
  for (const ArrayAtWork& array : arrays_) {
    McapMetadata totals{kTotalsMetadata,
                        {{"frames", std::to_string(array.written.frames())}, {"lost", std::to_string(array.lost)}}};
    if (arrays_.size() > 1) totals.values["name"] = array.written.description().name;
    mcap.add_metadata(totals);
  }
}

Status SuitRecordingWriter::Implementation::commit() {
  return writing_.finish([this](McapWriter& mcap) { add_totals(mcap); });
}

SuitRecordingWriter::SuitRecordingWriter(std::unique_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}

SuitRecordingWriter::~SuitRecordingWriter() = default;

Result<std::unique_ptr<SuitRecordingWriter>> SuitRecordingWriter::create(const std::string& path,
                                                                         std::vector<RecordedArray> arrays,
                                                                         const SuitRecordingOptions& options) {
  assert(!arrays.empty());
  for ([[maybe_unused]] const RecordedArray& array : arrays) assert(array.shape.taxel_count() > 0);
  if (const Status different = check_topics(arrays); !different) return different.error();
  Result<std::unique_ptr<McapWriter>> mcap = McapWriter::create(path, options.compression);
  if (!mcap) return mcap.error();
  return std::unique_ptr<SuitRecordingWriter>(
      new SuitRecordingWriter(std::make_unique<Implementation>(*std::move(mcap), std::move(arrays), options.live)));
}

Status SuitRecordingWriter::write(std::size_t array, const RawFrame& frame) {
  return implementation_->write(array, frame, nullptr);
}

Status SuitRecordingWriter::write(std::size_t array, const RawFrame& frame, const ForceFrame& force) {
  return implementation_->write(array, frame, &force);
}

Status SuitRecordingWriter::write(const RecordedEvent& event) {
  return implementation_->write(event);
}

Result<bool> SuitRecordingWriter::try_write(std::size_t array, const RawFrame& frame) {
  return implementation_->try_write(array, frame);
}

Result<bool> SuitRecordingWriter::try_write(const RecordedEvent& event) {
  return implementation_->try_write(event);
}

Status SuitRecordingWriter::commit() {
  return implementation_->commit();
}

}  // namespace dermis::bytes::recordings
