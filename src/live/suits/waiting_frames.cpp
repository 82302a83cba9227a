// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "live/suits/waiting_frames.hpp"

#include <algorithm>

namespace dermis::live::suits {

RawFrame& WaitingFrames::room() {
  if (count_ == ring_.size()) {
    std::rotate(ring_.begin(), ring_.begin() + static_cast<std::ptrdiff_t>(first_), ring_.end());
    first_ = 0;
    ring_.resize(2 * ring_.size());
  }
  return ring_[(first_ + count_) % ring_.size()];
}

}  // namespace dermis::live::suits
