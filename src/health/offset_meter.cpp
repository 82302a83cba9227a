// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "health/offset_meter.hpp"

#include <algorithm>

namespace dermis::health {

std::optional<double> OffsetMeter::drift() const {
  constexpr std::size_t kLeastFrames = 10;
  std::vector<double> drifts;
  for (std::size_t taxel = 0; taxel < share_.size(); ++taxel) {
    const auto frames = static_cast<double>(frames_[taxel]);
    if (frames_[taxel] >= kLeastFrames) drifts.push_back(share_[taxel] / frames - 1.0);
  }
  if (drifts.empty()) return std::nullopt;
  std::nth_element(drifts.begin(), drifts.begin() + static_cast<std::ptrdiff_t>(drifts.size() / 2), drifts.end());
  return drifts[drifts.size() / 2];
}

}  // namespace dermis::health
