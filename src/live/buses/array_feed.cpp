// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "live/buses/array_feed.hpp"

#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <limits>
#include <utility>

#include "dermis/bytes/files/taxel_text.hpp"

namespace dermis::live::buses {
namespace {

constexpr std::size_t kMostWaiting = 4096;

}  // namespace

std::uint32_t saturated_sum(std::uint32_t a, std::uint32_t b) {
  return a + std::min(b, std::numeric_limits<std::uint32_t>::max() - a);
}

ArrayFeed::ArrayFeed(std::function<void(const std::string&)> notice, std::string place, std::optional<FrameShape> shape)
    : notice_(std::move(notice)),
      place_(std::move(place)),
      event_(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)),
      shape_(shape) {}

ArrayFeed::~ArrayFeed() {
  if (event_ >= 0) ::close(event_);
}

void ArrayFeed::push(const FrameShape& shape, const RawFrame& frame) {
  assert(frame.counts.size() == shape.taxel_count());
  std::string news;
  {
    const std::lock_guard lock(mutex_);
    if (outcome_) return;
    if (!shape_) shape_ = shape;
    if (shape == *shape_) return add(frame);
    news = refuse(shape);
  }
  if (!news.empty()) tell(news);
}

/// Gives a notice where the user has had none.
std::string ArrayFeed::refuse(const FrameShape& shape) {
  if (!has_come_) {
    outcome_ = bad_input("frames are " + bytes::files::size_text(shape) + ", the array is " +
                         bytes::files::size_text(*shape_));
    signal();
    return {};
  }
  ++statistics_.damaged_frames;
  if (std::exchange(has_told_, true)) return {};
  return place_ + ": frames that are " + bytes::files::size_text(shape) + " are left out, as the array is " +
         bytes::files::size_text(*shape_);
}

void ArrayFeed::add(const RawFrame& frame) {
  has_come_ = true;
  statistics_.lost_frames += frame.acquisition.lost_before;
  if (count_ == kMostWaiting) {
    left_out_ = saturated_sum(left_out_, saturated_sum(1, ring_[first_].acquisition.lost_before));
    ++statistics_.lost_frames;
    first_ = (first_ + 1) % ring_.size();
    --count_;
  }
  if (count_ == ring_.size()) {
    std::rotate(ring_.begin(), ring_.begin() + static_cast<std::ptrdiff_t>(first_), ring_.end());
    first_ = 0;
    ring_.resize(std::min(kMostWaiting, std::max<std::size_t>(8, 2 * ring_.size())));
  }
  ring_[(first_ + count_) % ring_.size()] = frame;
  arrivals_.add(frame.acquisition.arrival_steady);
  if (count_++ == 0) signal();
}

void ArrayFeed::count_damaged() {
  const std::lock_guard lock(mutex_);
  ++statistics_.damaged_frames;
}

void ArrayFeed::count_reconnection() {
  const std::lock_guard lock(mutex_);
  ++statistics_.reconnections;
}

void ArrayFeed::tell(const std::string& text) const {
  if (notice_) notice_(text);
}

void ArrayFeed::end(const Status& outcome) {
  const std::lock_guard lock(mutex_);
  if (outcome_) return;
  outcome_ = outcome;
  signal();
}

Result<Polled> ArrayFeed::take(RawFrame& frame) {
  const std::lock_guard lock(mutex_);
  if (count_ == 0) {
    if (!outcome_) return Polled::nothing;
    return *outcome_ ? Result<Polled>(Polled::end) : outcome_->error();
  }
  std::swap(frame, ring_[first_]);
  first_ = (first_ + 1) % ring_.size();
  frame.acquisition.lost_before = saturated_sum(frame.acquisition.lost_before, std::exchange(left_out_, 0));
  ++statistics_.frames;
  if (--count_ == 0 && !outcome_) {
    eventfd_t ignored = 0;
    static_cast<void>(::eventfd_read(event_, &ignored));
  }
  return Polled::frame;
}

void ArrayFeed::wait(Nanos most) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, most, [&] { return count_ > 0 || outcome_; });
}

std::optional<FrameShape> ArrayFeed::shape() const {
  const std::lock_guard lock(mutex_);
  return shape_;
}

SourceStatistics ArrayFeed::statistics() const {
  const std::lock_guard lock(mutex_);
  SourceStatistics statistics = statistics_;
  statistics.rate_hz = arrivals_.rate_hz();
  statistics.jitter = arrivals_.jitter();
  return statistics;
}

void ArrayFeed::signal() {
  static_cast<void>(::eventfd_write(event_, 1));
  changed_.notify_all();
}

}  // namespace dermis::live::buses
