// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "live/sources/simulated_device.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

namespace dermis::live::sources {
namespace {

constexpr Nanos kDeviceBuffer = std::chrono::milliseconds(500);

}  // namespace

SimulatedDevice::SimulatedDevice(MakeFrame make_frame, const FrameShape& shape, double rate_hz,
                                 const std::atomic<bool>* stop)
    : make_frame_(std::move(make_frame)), shape_(shape), rate_hz_(rate_hz), stop_(stop) {}

Result<bool> SimulatedDevice::next(RawFrame& frame) {
  for (;;) {
    const Result<Polled> polled = poll(frame);
    if (!polled) return polled.error();
    if (*polled != Polled::nothing) return *polled == Polled::frame;
    if (!pacer_->wait_until(moment_of(next_))) return false;
  }
}

std::optional<Readiness> SimulatedDevice::readiness() const {
  return Readiness{.due = pacer_ ? begin_steady_ + moment_of(next_) : Nanos{}};
}

Result<Polled> SimulatedDevice::poll(RawFrame& frame) {
  if (stop_ != nullptr && stop_->load()) return Polled::end;
  if (!pacer_) begin();
  const Nanos now = pacer_->elapsed();
  const std::uint64_t lost = frames_overdue(now);
  const Nanos taken = moment_of(next_ + lost);
  if (taken > now) return Polled::nothing;
  next_ += lost;
  lost_ += lost;
  make_frame_(next_, frame);
  stamp(frame, taken, now, lost);
  ++next_;
  return Polled::frame;
}

void SimulatedDevice::begin() {
  pacer_.emplace(stop_);
  begin_steady_ = std::chrono::steady_clock::now().time_since_epoch();
  begin_utc_ = std::chrono::system_clock::now().time_since_epoch();
}

void SimulatedDevice::stamp(RawFrame& frame, Nanos taken, Nanos arrival, std::uint64_t lost) {
  frame.time = begin_utc_ + taken;
  frame.acquisition = {};
  frame.acquisition.sequence = next_;
  frame.acquisition.device_time = taken;
  frame.acquisition.lost_before = static_cast<std::uint32_t>(std::min<std::uint64_t>(lost, ~std::uint32_t{0}));
  frame.acquisition.arrival_steady = begin_steady_ + arrival;
  frame.acquisition.arrival_utc = begin_utc_ + arrival;
  if (frames_ == 0) first_arrival_ = arrival;
  last_arrival_ = arrival;
  ++frames_;
}

/// Older than the buffer is long.
std::uint64_t SimulatedDevice::frames_overdue(Nanos now) const {
  const Nanos oldest = now - kDeviceBuffer;
  const auto first_kept =
      static_cast<std::uint64_t>(std::max(0.0, 1e-9 * static_cast<double>(oldest.count()) * rate_hz_));
  return first_kept > next_ ? first_kept - next_ : 0;
}

Nanos SimulatedDevice::moment_of(std::uint64_t frame) const {
  return Nanos(std::llround(1e9 * static_cast<double>(frame) / rate_hz_));
}

SourceStatistics SimulatedDevice::statistics() const {
  SourceStatistics statistics;
  statistics.frames = frames_;
  statistics.lost_frames = lost_;
  const double seconds = std::chrono::duration<double>(last_arrival_ - first_arrival_).count();
  if (seconds > 0.0) statistics.rate_hz = static_cast<double>(frames_ - 1) / seconds;
  return statistics;
}

}  // namespace dermis::live::sources
