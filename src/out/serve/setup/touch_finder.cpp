// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/setup/touch_finder.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace dermis::out::serve {
namespace {

constexpr float kNoises = 3.0F;  // A touch is so many ranges of the noise from rest,
constexpr float kCounts = 4.0F;  // and this much more.

}  // namespace

TouchFinder::TouchFinder(std::size_t taxels)
    : lowest_(taxels, std::numeric_limits<float>::infinity()),
      highest_(taxels, -std::numeric_limits<float>::infinity()) {}

void TouchFinder::add(std::span<const float> counts) {
  assert(counts.size() == lowest_.size());
  is_ready() ? look(counts) : learn(counts);
}

void TouchFinder::learn(std::span<const float> counts) {
  ++frames_;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (!std::isfinite(counts[i])) continue;
    lowest_[i] = std::min(lowest_[i], counts[i]);
    highest_[i] = std::max(highest_[i], counts[i]);
    if (is_ready()) noise_ = std::max(noise_, highest_[i] - lowest_[i]);
  }
}

void TouchFinder::look(std::span<const float> counts) {
  float farthest = kNoises * noise_ + kCounts;
  touched_.reset();
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const float distance = std::max(counts[i] - highest_[i], lowest_[i] - counts[i]);
    if (!std::isfinite(distance) || !(distance > farthest)) continue;
    farthest = distance;
    touched_ = i;
  }
}

}  // namespace dermis::out::serve
