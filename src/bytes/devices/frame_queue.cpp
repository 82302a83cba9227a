// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/devices/frame_queue.hpp"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <utility>

namespace dermis::bytes::devices {

FrameQueue::FrameQueue(std::size_t capacity, Overflow overflow) : ring_(capacity), overflow_(overflow) {
  assert(capacity > 0);
}

bool FrameQueue::push(RawFrame& frame) {
  std::unique_lock lock(mutex_);
  if (count_ == ring_.size() && overflow_ == Overflow::wait && !left_) wait_for_room(lock);
  if (left_) return false;
  if (count_ == ring_.size()) {
    first_ = (first_ + 1) % ring_.size();
    --count_;
    ++statistics_.dropped;
  }
  std::swap(ring_[(first_ + count_) % ring_.size()], frame);
  ++count_;
  statistics_.most_depth = std::max(statistics_.most_depth, count_);
  const bool was_empty = count_ == 1;
  lock.unlock();
  if (was_empty) changed_.notify_all();
  return true;
}

void FrameQueue::wait_for_room(std::unique_lock<std::mutex>& lock) {
  const auto begin = std::chrono::steady_clock::now();
  ++statistics_.waits;
  changed_.wait(lock, [&] { return count_ < ring_.size() || left_; });
  const Nanos waited = std::chrono::steady_clock::now() - begin;
  statistics_.longest_wait = std::max(statistics_.longest_wait, waited);
}

FrameQueue::Pop FrameQueue::pop(RawFrame& frame, Nanos timeout) {
  std::unique_lock lock(mutex_);
  if (!changed_.wait_for(lock, timeout, [&] { return count_ > 0 || closed_; })) return Pop::timeout;
  if (count_ == 0) return Pop::end;
  std::swap(ring_[first_], frame);
  first_ = (first_ + 1) % ring_.size();
  const bool was_full = count_-- == ring_.size();
  lock.unlock();
  if (was_full) changed_.notify_all();
  return Pop::frame;
}

void FrameQueue::close() {
  const std::lock_guard lock(mutex_);
  closed_ = true;
  changed_.notify_all();
}

void FrameQueue::leave() {
  const std::lock_guard lock(mutex_);
  left_ = true;
  changed_.notify_all();
}

QueueStatistics FrameQueue::statistics() const {
  const std::lock_guard lock(mutex_);
  QueueStatistics now = statistics_;
  now.depth = count_;
  return now;
}

}  // namespace dermis::bytes::devices
