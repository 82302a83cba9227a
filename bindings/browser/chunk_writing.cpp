// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// ChunkWriting for the one thread of a page: who adds writes.
#include "bytes/recordings/chunk_writing.hpp"

#include <chrono>
#include <limits>
#include <utility>

namespace dermis::bytes::recordings {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kChunkTime{50};
constexpr std::chrono::seconds kSynchronisePeriod{1};

}  // namespace

class ChunkWriting::Implementation {
 public:
  Implementation(std::unique_ptr<McapWriter> mcap, std::size_t chunk_bytes, bool live)
      : mcap_(std::move(mcap)), chunk_bytes_(chunk_bytes), live_(live) {}

  [[nodiscard]] Status add(const Add& add) {
    if (!status_) return status_;
    add(*mcap_);
    const Clock::time_point now = Clock::now();
    if (mcap_->chunk_bytes() >= chunk_bytes_ || now >= chunk_due_) {
      status_ = write_chunk();
      chunk_due_ = now + kChunkTime;
    }
    if (status_ && now >= synchronise_due_) {
      status_ = mcap_->synchronise();
      synchronise_due_ = now + kSynchronisePeriod;
    }
    return Done{};
  }

  [[nodiscard]] Status finish(const Add& last) {
    last(*mcap_);
    const Status finished = mcap_->finish();
    return status_ ? finished : status_;
  }

  [[nodiscard]] Status write_chunk() {
    const Status written = mcap_->close_chunk();
    return written && live_ ? mcap_->appear() : written;
  }

  [[nodiscard]] McapWriter& mcap() { return *mcap_; }

 private:
  std::unique_ptr<McapWriter> mcap_;
  std::size_t chunk_bytes_;
  bool live_;
  Status status_ = Done{};
  Clock::time_point chunk_due_ = Clock::now() + kChunkTime;
  Clock::time_point synchronise_due_ = Clock::now() + kSynchronisePeriod;
};

ChunkWriting::ChunkWriting(std::unique_ptr<McapWriter> mcap, std::size_t chunk_bytes, bool live)
    : implementation_(std::make_unique<Implementation>(std::move(mcap), chunk_bytes, live)) {}

ChunkWriting::~ChunkWriting() {
  static_cast<void>(implementation_->write_chunk());
}

std::size_t ChunkWriting::most_chunks() const noexcept {
  return std::numeric_limits<std::size_t>::max();  // none waits
}

Status ChunkWriting::add(const Add& add) {
  return implementation_->add(add);
}

Result<bool> ChunkWriting::try_add(const Add& add, std::size_t /*most_chunks*/) {
  const Status added = implementation_->add(add);
  if (!added) return added.error();
  return true;
}

Status ChunkWriting::finish(const Add& last) {
  return implementation_->finish(last);
}

McapWriter& ChunkWriting::mcap() noexcept {
  return implementation_->mcap();
}

}  // namespace dermis::bytes::recordings
