// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "live/dds/writing_queue.hpp"

#include <utility>

namespace dermis::live::dds {

WritingQueue::WritingQueue(std::size_t most_bytes) : most_bytes_(most_bytes), thread_([this] { write_messages(); }) {}

WritingQueue::~WritingQueue() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

bool WritingQueue::push(Writer& writer, std::span<const std::uint8_t> message) {
  {
    const std::lock_guard lock(mutex_);
    if (message.size() > most_bytes_ - bytes_) return false;
    bytes_ += message.size();
    Waiting& last = waiting_.emplace_back();
    last.writer = &writer;
    if (!spare_.empty()) {
      last.bytes = std::move(spare_.back());
      spare_.pop_back();
    }
    last.bytes.assign(message.begin(), message.end());
  }
  wake_.notify_one();
  return true;
}

void WritingQueue::write_messages() {
  std::vector<Waiting> batch;
  std::unique_lock lock(mutex_);
  while (true) {
    wake_.wait(lock, [this] { return stopping_ || !waiting_.empty(); });
    if (waiting_.empty()) return;
    std::swap(batch, waiting_);
    lock.unlock();
    for (const Waiting& message : batch) message.writer->write(message.bytes);
    lock.lock();
    for (Waiting& message : batch) {
      bytes_ -= message.bytes.size();
      spare_.push_back(std::move(message.bytes));
    }
    batch.clear();
  }
}

}  // namespace dermis::live::dds
