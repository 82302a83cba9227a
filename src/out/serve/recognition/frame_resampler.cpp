// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/recognition/frame_resampler.hpp"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>
#include <cstdint>

namespace dermis::out::serve {
namespace {

constexpr Nanos kLongestGap = std::chrono::milliseconds(500);

/// A taxel without a value has no load, so that it spoils no frame but its own.
float finite_newtons(float newtons) noexcept {
  return std::isfinite(newtons) ? newtons : 0.0F;
}

}  // namespace

FrameResampler::FrameResampler(double rate_hz, std::size_t taxels)
    : period_(rate_hz > 0.0 ? static_cast<std::int64_t>(1e9 / rate_hz) : 0), last_newtons_(taxels), between_(taxels) {}

bool FrameResampler::leaps_to(const ForceFrame& force) const noexcept {
  return !last_ || force.time < *last_ || force.time - *last_ > kLongestGap;
}

void FrameResampler::restart(const ForceFrame& force) noexcept {
  due_ = force.time;
  keep(force);
}

std::span<const float> FrameResampler::interpolated(const ForceFrame& force) noexcept {
  const auto span = static_cast<double>((force.time - *last_).count());
  const auto weight = static_cast<float>(span > 0.0 ? static_cast<double>((due_ - *last_).count()) / span : 1.0);
  for (std::size_t k = 0; k < between_.size(); ++k) {
    between_[k] = last_newtons_[k] + weight * (finite_newtons(force.newtons[k]) - last_newtons_[k]);
  }
  return between_;
}

void FrameResampler::keep(const ForceFrame& force) noexcept {
  assert(force.newtons.size() == last_newtons_.size());
  last_ = force.time;
  std::transform(force.newtons.begin(), force.newtons.end(), last_newtons_.begin(), finite_newtons);
}

}  // namespace dermis::out::serve
