// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/recordings/chunk_writing.hpp"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>

#include "dermis/bytes/system/thread_priority.hpp"

namespace dermis::bytes::recordings {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kChunkTime{50};
constexpr std::size_t kMostWaitingBytes = std::size_t{64} << 20U;  ///< For a disk that stalls.
constexpr std::chrono::seconds kSynchronisePeriod{1};

}  // namespace

class ChunkWriting::Implementation {
 public:
  Implementation(std::unique_ptr<McapWriter> mcap, std::size_t chunk_bytes, bool live);
  ~Implementation();

  [[nodiscard]] std::size_t most_chunks() const { return kMostWaitingBytes / chunk_bytes_; }
  [[nodiscard]] Status add(const Add& add);
  [[nodiscard]] Result<bool> try_add(const Add& add, std::size_t most_chunks);
  [[nodiscard]] Status finish(const Add& last);
  [[nodiscard]] McapWriter& mcap() { return *mcap_; }

 private:
  void add_to_chunk(const Add& add);
  void seal_chunk();
  void write_chunks(const std::stop_token& stop);
  [[nodiscard]] Status write_sealed();
  void synchronise(const std::stop_token& stop);
  void stop_threads();

  std::unique_ptr<McapWriter> mcap_;
  std::size_t chunk_bytes_;
  bool live_;

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

ChunkWriting::Implementation::Implementation(std::unique_ptr<McapWriter> mcap, std::size_t chunk_bytes, bool live)
    : mcap_(std::move(mcap)), chunk_bytes_(chunk_bytes), live_(live) {
  writer_ = std::jthread([this](const std::stop_token& stop) { write_chunks(stop); });
  synchroniser_ = std::jthread([this](const std::stop_token& stop) { synchronise(stop); });
}

ChunkWriting::Implementation::~Implementation() {
  stop_threads();
  if (!status_ || (chunk_due_ == Clock::time_point::max() && waiting_chunks_ == 0)) return;
  seal_chunk();
  for (; waiting_chunks_ > 0; --waiting_chunks_) static_cast<void>(write_sealed());
}

void ChunkWriting::Implementation::seal_chunk() {
  chunk_due_ = Clock::time_point::max();
  mcap_->seal_chunk();
  ++waiting_chunks_;
}

void ChunkWriting::Implementation::write_chunks(const std::stop_token& stop) {
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

Status ChunkWriting::Implementation::write_sealed() {
  const Status written = mcap_->write_sealed();
  return written && live_ ? mcap_->appear() : written;
}

void ChunkWriting::Implementation::synchronise(const std::stop_token& stop) {
  std::unique_lock lock(stopping_mutex_);
  while (!stopping_.wait_for(lock, stop, kSynchronisePeriod, [&stop] { return stop.stop_requested(); })) {
    const Status synchronised = mcap_->synchronise();
    if (synchronised) continue;
    const std::scoped_lock frames_lock(mutex_);
    if (status_) status_ = synchronised;
    return;
  }
}

void ChunkWriting::Implementation::stop_threads() {
  writer_ = {};
  synchroniser_ = {};
}

Status ChunkWriting::Implementation::add(const Add& add) {
  std::unique_lock lock(mutex_);
  room_.wait(lock, [this] { return !status_ || waiting_chunks_ < most_chunks(); });
  if (!status_) return status_;
  add_to_chunk(add);
  return Done{};
}

Result<bool> ChunkWriting::Implementation::try_add(const Add& add, std::size_t most_chunks) {
  const std::scoped_lock lock(mutex_);
  if (!status_) return status_.error();
  if (waiting_chunks_ >= most_chunks) return false;
  add_to_chunk(add);
  return true;
}

void ChunkWriting::Implementation::add_to_chunk(const Add& add) {
  add(*mcap_);
  bool has_work = chunk_due_ == Clock::time_point::max();
  if (has_work) chunk_due_ = Clock::now() + kChunkTime;
  if (mcap_->chunk_bytes() >= chunk_bytes_) {
    seal_chunk();
    has_work = true;
  }
  if (has_work) work_.notify_one();
}

Status ChunkWriting::Implementation::finish(const Add& last) {
  stop_threads();
  chunk_due_ = Clock::time_point::max();
  waiting_chunks_ = 0;
  last(*mcap_);
  const Status finished = mcap_->finish();
  return status_ ? finished : status_;
}

ChunkWriting::ChunkWriting(std::unique_ptr<McapWriter> mcap, std::size_t chunk_bytes, bool live)
    : implementation_(std::make_unique<Implementation>(std::move(mcap), chunk_bytes, live)) {}

ChunkWriting::~ChunkWriting() = default;

std::size_t ChunkWriting::most_chunks() const noexcept {
  return implementation_->most_chunks();
}

Status ChunkWriting::add(const Add& add) {
  return implementation_->add(add);
}

Result<bool> ChunkWriting::try_add(const Add& add, std::size_t most_chunks) {
  return implementation_->try_add(add, most_chunks);
}

Status ChunkWriting::finish(const Add& last) {
  return implementation_->finish(last);
}

McapWriter& ChunkWriting::mcap() noexcept {
  return implementation_->mcap();
}

}  // namespace dermis::bytes::recordings
