// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/recognition/frame_joiner.hpp"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <numeric>

namespace dermis::out::serve {

FrameJoiner::FrameJoiner(const std::vector<std::size_t>& taxels) {
  for (std::size_t array = 1; array < taxels.size(); ++array) {
    others_.emplace_back().newtons.resize(taxels[array]);
  }
  joined_.newtons.resize(std::accumulate(taxels.begin(), taxels.end(), std::size_t{0}));
}

void FrameJoiner::keep(std::size_t array, const ForceFrame& force) {
  if (has(force.status, FrameStatus::rejected)) return;
  const std::lock_guard lock(mutex_);
  Kept& kept = others_[array - 1];
  assert(force.newtons.size() == kept.newtons.size());
  std::copy(force.newtons.begin(), force.newtons.end(), kept.newtons.begin());
  kept.time = force.time;
}

const ForceFrame& FrameJoiner::join(const ForceFrame& first) {
  joined_.time = first.time;
  joined_.status = first.status;
  auto end = std::copy(first.newtons.begin(), first.newtons.end(), joined_.newtons.begin());
  const std::lock_guard lock(mutex_);
  for (const Kept& kept : others_) {
    const bool is_near = kept.time && std::chrono::abs(*kept.time - first.time) <= learn::recognition::kLongestSilence;
    end = is_near ? std::copy(kept.newtons.begin(), kept.newtons.end(), end)
                  : std::fill_n(end, kept.newtons.size(), 0.0F);
  }
  return joined_;
}

}  // namespace dermis::out::serve
