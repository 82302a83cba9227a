// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "live/suits/work_loop.hpp"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <optional>
#include <utility>

#include "dermis/bytes/system/thread_priority.hpp"

namespace dermis::live::suits {
namespace {

constexpr Nanos kTick = std::chrono::milliseconds(50);  // a loop that shall stop notices it so soon

// Between two wake-ups: one serves the frames of several arrays, the more the more arrays there are.
constexpr Nanos kPauseForArray = std::chrono::microseconds(25);
constexpr Nanos kLongestPause = std::chrono::microseconds(250);

Nanos steady_now() {
  return std::chrono::steady_clock::now().time_since_epoch();
}

timespec timespec_of(Nanos span) {
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(span);
  return {.tv_sec = seconds.count(), .tv_nsec = (span - seconds).count()};
}

}  // namespace

void WorkLoop::start() {
  thread_ = std::thread([this] { run(); });
}

void WorkLoop::stop() {
  ask_to_stop();
  if (thread_.joinable()) thread_.join();
  for (Member& member : members_) {
    if (member.alone.joinable()) member.alone.join();
    member.worker.stop();
  }
}

void WorkLoop::run() {
  raise_thread_priority();
  pause_ = std::min(static_cast<std::int64_t>(members_.size()) * kPauseForArray, kLongestPause);
  bool has_work = false;
  while (!is_stopping() && has_any()) {
    const Nanos due = collect();
    has_work ? poll_until(Nanos{}) : wait_until(due);
    acquire();
    has_work = process();
  }
}

bool WorkLoop::has_any() const {
  return std::ranges::any_of(members_, [](const Member& member) { return !member.worker.ended(); });
}

/// The descriptors to wait for; returns until when.
Nanos WorkLoop::collect() {
  descriptors_.clear();
  described_.clear();
  Nanos first = steady_now() + kTick;
  for (Member& member : members_) {
    member.is_here = !member.is_alone.load(std::memory_order_acquire) && !member.worker.ended();
    if (!member.is_here) continue;
    const std::optional<Readiness> readiness = member.worker.readiness();
    if (!readiness) {
      leave_alone(member);
      continue;
    }
    member.due = readiness->due;
    first = std::min(first, member.due);
    if (readiness->descriptor < 0) continue;
    descriptors_.push_back({readiness->descriptor, POLLIN, 0});
    described_.push_back(&member);
  }
  return first;
}

void WorkLoop::wait_until(Nanos due) {
  poll_until(descriptors_.empty() ? std::max(due, woken_ + pause_) : due);
  woken_ += pause_;
  const Nanos now = steady_now();
  if (now < woken_ && !descriptors_.empty()) {
    std::this_thread::sleep_for(woken_ - now);
    poll_until(Nanos{});
  }
  woken_ = std::max(now, woken_);
}

void WorkLoop::poll_until(Nanos due) {
  const Nanos span = std::max(due - steady_now(), Nanos{});
  if (descriptors_.empty() && span == Nanos{}) return;
  const timespec timeout = timespec_of(span);
  if (::ppoll(descriptors_.data(), descriptors_.size(), &timeout, nullptr) <= 0) return;
  for (std::size_t k = 0; k < descriptors_.size(); ++k) {
    if (descriptors_[k].revents != 0) described_[k]->has_come = true;
  }
}

void WorkLoop::acquire() {
  const Nanos now = steady_now();
  for (Member& member : members_) {
    if (!member.is_here) continue;
    if (std::exchange(member.has_come, false) || member.due <= now) member.worker.acquire();
  }
}

/// A frame of each array. Returns whether there are more.
bool WorkLoop::process() {
  bool has_more = false;
  for (Member& member : members_) {
    if (member.is_here && member.worker.process()) has_more = true;
  }
  return has_more;
}

void WorkLoop::leave_alone(Member& member) {
  if (member.alone.joinable()) member.alone.join();
  member.is_here = false;
  member.is_alone = true;
  member.alone = std::thread([this, &member] { work_alone(member); });
}

void WorkLoop::work_alone(Member& member) {
  ArrayWorker& worker = member.worker;
  while (worker.process()) {
  }
  while (!is_stopping() && !worker.ended() && !worker.readiness()) {
    worker.await();
    static_cast<void>(worker.process());
  }
  member.is_alone.store(false, std::memory_order_release);
}

}  // namespace dermis::live::suits
