// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/devices/clock_mapping.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

namespace dermis {
namespace {

constexpr double kWindowNs = 30e9;
constexpr double kLeastDriftSpanNs = 1e9;
constexpr double kMostSlope = 0.02;    // a clock without crystal
constexpr double kLeastLeapNs = 50e6;  // ahead of the line by more: no clock drifts so fast
constexpr double kMostTickNs = 1e9;    // a clock that stands for longer has stopped

/// From `begin` to `end`; a device may say anything: beyond 292 years the difference wraps.
double nanoseconds_between(Nanos begin, Nanos end) {
  const std::uint64_t difference = static_cast<std::uint64_t>(end.count()) - static_cast<std::uint64_t>(begin.count());
  return static_cast<double>(static_cast<std::int64_t>(difference));
}

}  // namespace

void ClockMapping::Hull::clear() noexcept {
  vertices_.clear();
  sum_device_ns_ = 0.0;
  pairs_ = 0.0;
}

void ClockMapping::Hull::add(const Pair& pair) {
  // Andrew's monotone chain: a vertex on or above the line from the one before it to the new pair is none.
  const auto is_none = [&](const Pair& before, const Pair& last) {
    return (last.lag_ns - before.lag_ns) * (pair.device_ns - before.device_ns) >=
           (pair.lag_ns - before.lag_ns) * (last.device_ns - before.device_ns);
  };
  while (vertices_.size() >= 2 && is_none(vertices_[vertices_.size() - 2], vertices_.back())) vertices_.pop_back();
  if (vertices_.size() == kMaxVertices) vertices_.erase(vertices_.begin());
  vertices_.push_back(pair);
  sum_device_ns_ += pair.device_ns;
  pairs_ += 1.0;
}

double ClockMapping::Hull::span_ns() const noexcept {
  return vertices_.empty() ? 0.0 : vertices_.back().device_ns - vertices_.front().device_ns;
}

double ClockMapping::Hull::middle_slope() const noexcept {
  if (vertices_.size() < 2) return 0.0;
  const double middle = sum_device_ns_ / pairs_;
  const auto is_before = [](const Pair& vertex, double device_ns) { return vertex.device_ns < device_ns; };
  auto right = std::lower_bound(vertices_.begin() + 1, vertices_.end() - 1, middle, is_before);
  const Pair& left = *(right - 1);
  return (right->lag_ns - left.lag_ns) / (right->device_ns - left.device_ns);
}

double ClockMapping::Hull::offset_below(double slope) const noexcept {
  double offset = std::numeric_limits<double>::infinity();
  for (const Pair& vertex : vertices_) offset = std::min(offset, vertex.lag_ns - slope * vertex.device_ns);
  return offset;
}

void ClockMapping::restart() noexcept {
  hull_.clear();
  next_.clear();
  first_device_.reset();
  slope_ = 0.0;
  offset_ns_ = 0.0;
}

bool ClockMapping::has_restarted(Nanos device_time, Nanos arrival) const noexcept {
  const double gap_ns = nanoseconds_between(last_device_, device_time);
  if (gap_ns < 0.0) return true;
  const double device_ns = nanoseconds_between(*first_device_, device_time);
  const double lag_ns = nanoseconds_between(first_arrival_, arrival) - device_ns;
  const double delay_ns = lag_ns - offset_ns_ - slope_ * device_ns;
  return gap_ns > 0.0 ? delay_ns < -kLeastLeapNs - kMostSlope * gap_ns : delay_ns > kMostTickNs;
}

Nanos ClockMapping::map(Nanos device_time, Nanos arrival) {
  if (first_device_ && has_restarted(device_time, arrival)) restart();
  if (!first_device_) {
    first_device_ = device_time;
    first_arrival_ = arrival;
  }
  const bool is_new = hull_.is_empty() || device_time != last_device_;
  if (!is_new && device_time == *first_device_) return arrival;
  last_device_ = device_time;
  const double device_ns = nanoseconds_between(*first_device_, device_time);
  const Pair pair{device_ns, nanoseconds_between(first_arrival_, arrival) - device_ns};
  if (is_new) add(pair);
  slope_ = std::clamp(hull_.middle_slope(), -kMostSlope, kMostSlope);
  offset_ns_ = hull_.offset_below(slope_);
  const double delay_ns = std::max(0.0, pair.lag_ns - offset_ns_ - slope_ * device_ns);
  return arrival - Nanos(std::llround(delay_ns));
}

void ClockMapping::add(const Pair& pair) {
  hull_.add(pair);
  if (hull_.span_ns() >= kWindowNs / 2.0) next_.add(pair);
  if (hull_.span_ns() < kWindowNs) return;
  std::swap(hull_, next_);
  next_.clear();
}

std::optional<double> ClockMapping::drift_ppm() const noexcept {
  if (hull_.span_ns() < kLeastDriftSpanNs) return std::nullopt;
  return -1e6 * slope_ / (1.0 + slope_);
}

}  // namespace dermis
