// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <algorithm>
#include <cassert>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "bytes/recordings/recording_format.hpp"
#include "bytes/recordings/written_array.hpp"
#include "dermis/bytes/files/text.hpp"
#include "dermis/bytes/recordings/suit_recording.hpp"
#include "dermis/bytes/system/thread_priority.hpp"

namespace dermis::bytes::recordings {
namespace {

using Clock = std::chrono::steady_clock;

// A chunk ends at the earlier of these.
constexpr std::chrono::milliseconds kChunkTime{50};
constexpr std::size_t kChunkBytes = std::size_t{1} << 20U;
constexpr std::size_t kSuitChunkBytes = std::size_t{8} << 20U;  ///< Each chunk has an index of each topic.

constexpr std::size_t kMostWaitingBytes = std::size_t{64} << 20U;  ///< For a disk that stalls.

constexpr std::size_t kShareOfResults = 8;  ///< The part of that room in which results may wait.

constexpr std::chrono::seconds kSynchronisePeriod{1};

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
  ~Implementation();

  [[nodiscard]] Status write(std::size_t array, const RawFrame& frame, const ForceFrame* force_frame);
  [[nodiscard]] Status write(const RecordedEvent& event);
  [[nodiscard]] Result<bool> try_write(std::size_t array, const RawFrame& frame);
  [[nodiscard]] Result<bool> try_write(const RecordedEvent& event);
  [[nodiscard]] Status commit();

 private:
  void describe(const RecordedArray& array);
  void add(ArrayAtWork& array);
  void add(const RecordedEvent& event);
  [[nodiscard]] std::size_t most_chunks() const { return kMostWaitingBytes / chunk_bytes_; }
  template <typename Written>
  [[nodiscard]] Status wait_and_add(Written& written);
  template <typename Written>
  [[nodiscard]] Result<bool> try_to_add(Written& written, std::size_t most_chunks);
  template <typename Written>
  void add_to_chunk(Written& written);
  void seal_chunk();
  void write_chunks(const std::stop_token& stop);
  [[nodiscard]] Status write_sealed();
  void synchronise(const std::stop_token& stop);
  void stop_threads();

  std::unique_ptr<McapWriter> mcap_;
  std::vector<ArrayAtWork> arrays_;  ///< Each of the thread that writes its frames.
  std::map<std::string, EventTopic, std::less<>> event_topics_;
  bool live_;
  std::size_t chunk_bytes_;

  std::mutex mutex_;  ///< Guards additions to mcap_ and the next three.
  Status status_ = Done{};
  Clock::time_point chunk_due_ = Clock::time_point::max();
  std::size_t waiting_chunks_ = 0;
  std::condition_variable_any work_;
  std::condition_variable_any room_;
  std::condition_variable_any stopping_;
  std::mutex stopping_mutex_;
  std::jthread writer_;        ///< Writes chunks, and ends those that no frame ends.
  std::jthread synchroniser_;  ///< Has the disk keep what is in the file.
};

SuitRecordingWriter::Implementation::Implementation(std::unique_ptr<McapWriter> mcap, std::vector<RecordedArray> arrays,
                                                    bool live)
    : mcap_(std::move(mcap)), live_(live), chunk_bytes_(arrays.size() == 1 ? kChunkBytes : kSuitChunkBytes) {
  for (RecordedArray& array : arrays) arrays_.emplace_back(std::move(array));
  for (const ArrayAtWork& array : arrays_) describe(array.written.description());
  writer_ = std::jthread([this](const std::stop_token& stop) { write_chunks(stop); });
  synchroniser_ = std::jthread([this](const std::stop_token& stop) { synchronise(stop); });
}

SuitRecordingWriter::Implementation::~Implementation() {
  stop_threads();
  if (!status_ || (chunk_due_ == Clock::time_point::max() && waiting_chunks_ == 0)) return;
  seal_chunk();
  for (; waiting_chunks_ > 0; --waiting_chunks_) static_cast<void>(write_sealed());
}

void SuitRecordingWriter::Implementation::describe(const RecordedArray& array) {
  mcap_->add_metadata(metadata_of(array));
  const std::string name = arrays_.size() == 1 ? "" : array.name;
  const auto attach = [&](const char* of, const char* type, const std::string& data) {
    if (!data.empty()) mcap_->add_attachment({attachment_name(of, name), type, data});
  };
  attach(kArrayAttachment, "application/toml", array.array_toml);
  attach(kModelAttachment, "application/octet-stream", array.model_file);
}

/// The messages of the frame go into the chunk.
void SuitRecordingWriter::Implementation::add(ArrayAtWork& array) {
  array.written.add_to(*mcap_);
}

void SuitRecordingWriter::Implementation::add(const RecordedEvent& event) {
  auto topic = event_topics_.find(event.topic);
  if (topic == event_topics_.end()) {
    const std::string name(event.topic);
    const std::uint16_t channel = mcap_->add_channel({name, "cdr", event.type.name, "ros2msg", event.type.definition});
    topic = event_topics_.emplace(name, EventTopic{channel}).first;
  }
  const std::uint64_t log_time = log_time_of(event.time);
  mcap_->add_message({topic->second.channel, topic->second.messages++, log_time, log_time, event.message});
}

void SuitRecordingWriter::Implementation::seal_chunk() {
  chunk_due_ = Clock::time_point::max();
  mcap_->seal_chunk();
  ++waiting_chunks_;
}

void SuitRecordingWriter::Implementation::write_chunks(const std::stop_token& stop) {
  raise_thread_priority();
  std::unique_lock lock(mutex_);
  while (status_ && !stop.stop_requested()) {
    const auto has_work = [this] { return waiting_chunks_ > 0; };
    if (chunk_due_ == Clock::time_point::max()) {
      work_.wait(lock, stop, [&] { return has_work() || chunk_due_ != Clock::time_point::max(); });
    } else {
      const Clock::time_point due = chunk_due_;
      work_.wait_until(lock, stop, due, has_work);
    }
    if (Clock::now() >= chunk_due_) seal_chunk();
    if (!has_work()) continue;
    lock.unlock();
    const Status written = write_sealed();
    lock.lock();
    --waiting_chunks_;
    if (status_) status_ = written;
    room_.notify_all();
  }
}

Status SuitRecordingWriter::Implementation::write_sealed() {
  const Status written = mcap_->write_sealed();
  return written && live_ ? mcap_->appear() : written;
}

void SuitRecordingWriter::Implementation::synchronise(const std::stop_token& stop) {
  std::unique_lock lock(stopping_mutex_);
  while (!stopping_.wait_for(lock, stop, kSynchronisePeriod, [&stop] { return stop.stop_requested(); })) {
    const Status synchronised = mcap_->synchronise();
    if (synchronised) continue;
    const std::scoped_lock frames_lock(mutex_);
    if (status_) status_ = synchronised;
    return;
  }
}

void SuitRecordingWriter::Implementation::stop_threads() {
  writer_ = {};
  synchroniser_ = {};
}

Status SuitRecordingWriter::Implementation::write(std::size_t index, const RawFrame& frame,
                                                  const ForceFrame* force_frame) {
  assert(index < arrays_.size());
  ArrayAtWork& array = arrays_[index];
  array.written.encode(frame, force_frame);
  array.lost += frame.acquisition.lost_before;
  return wait_and_add(array);
}

Status SuitRecordingWriter::Implementation::write(const RecordedEvent& event) {
  return wait_and_add(event);
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
  Result<bool> added = try_to_add(array, most_chunks());
  const bool is_left_out = added && !*added;
  array.lost += frame.acquisition.lost_before + (is_left_out ? 1 : 0);
  array.left_out = is_left_out ? array.left_out + frame.acquisition.lost_before + 1 : 0;
  return added;
}

Result<bool> SuitRecordingWriter::Implementation::try_write(const RecordedEvent& event) {
  return try_to_add(event, event.is_of_frame ? most_chunks() / kShareOfResults : 2 * most_chunks());
}

template <typename Written>
Status SuitRecordingWriter::Implementation::wait_and_add(Written& written) {
  std::unique_lock lock(mutex_);
  room_.wait(lock, [this] { return !status_ || waiting_chunks_ < most_chunks(); });
  if (!status_) return status_;
  add_to_chunk(written);
  return Done{};
}

template <typename Written>
Result<bool> SuitRecordingWriter::Implementation::try_to_add(Written& written, std::size_t most_chunks) {
  const std::scoped_lock lock(mutex_);
  if (!status_) return status_.error();
  if (waiting_chunks_ >= most_chunks) return false;
  add_to_chunk(written);
  return true;
}

template <typename Written>
void SuitRecordingWriter::Implementation::add_to_chunk(Written& written) {
  add(written);
  bool has_work = chunk_due_ == Clock::time_point::max();
  if (has_work) chunk_due_ = Clock::now() + kChunkTime;
  if (mcap_->chunk_bytes() >= chunk_bytes_) {
    seal_chunk();
    has_work = true;
  }
  if (has_work) work_.notify_one();
}

Status SuitRecordingWriter::Implementation::commit() {
  stop_threads();
  chunk_due_ = Clock::time_point::max();
  waiting_chunks_ = 0;
  for (const ArrayAtWork& array : arrays_) {
    McapMetadata totals{kTotalsMetadata,
                        {{"frames", std::to_string(array.written.frames())}, {"lost", std::to_string(array.lost)}}};
    if (arrays_.size() > 1) totals.values["name"] = array.written.description().name;
    mcap_->add_metadata(totals);
  }
  const Status finished = mcap_->finish();
  return status_ ? finished : status_;
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
