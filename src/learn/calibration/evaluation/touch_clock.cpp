// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/evaluation/touch_clock.hpp"

#include <chrono>
#include <cmath>

namespace dermis::learn::calibration {
namespace {

constexpr Nanos kOneTouch = std::chrono::seconds(1);
constexpr double kChange = 0.01;  // of the force: less is no loading and no unloading

double seconds_between(Nanos from, Nanos to) {
  return std::chrono::duration<double>(to - from).count();
}

}  // namespace

void PlaceClock::add(Nanos time, double newtons) {
  const bool follows = last_ && time > *last_ && time - *last_ <= kOneTouch;
  if (!follows) *this = {};
  if (newtons > 0.0) {
    release_.reset();
    if (follows && newtons_ == 0.0) onset_ = time;
    const bool is_change = std::abs(newtons - newtons_) > kChange * newtons_;
    if (follows && is_change) is_unloading_ = newtons < newtons_;
    if (!follows || is_change) newtons_ = newtons;
  } else {
    if (follows && newtons_ > 0.0) release_ = time;
    onset_.reset();
    is_unloading_.reset();
    newtons_ = 0.0;
  }
  last_ = time;
}

TouchTime PlaceClock::touch() const {
  TouchTime touch;
  if (onset_) touch.seconds_since_onset = seconds_between(*onset_, *last_);
  touch.is_unloading = is_unloading_;
  return touch;
}

std::optional<double> PlaceClock::seconds_since_release() const {
  if (!release_) return std::nullopt;
  return seconds_between(*release_, *last_);
}

}  // namespace dermis::learn::calibration
