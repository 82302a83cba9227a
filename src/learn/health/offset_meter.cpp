// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/health/offset_meter.hpp"

#include <utility>

#include "dermis/touch/frames/quantile.hpp"

namespace dermis::learn::health {

std::vector<double> OffsetMeter::drifts() const {
  constexpr std::size_t kLeastFrames = 10;
  std::vector<double> drifts;
  for (std::size_t taxel = 0; taxel < share_.size(); ++taxel) {
    const auto frames = static_cast<double>(frames_[taxel]);
    if (frames_[taxel] >= kLeastFrames) drifts.push_back(share_[taxel] / frames - 1.0);
  }
  return drifts;
}

std::optional<double> OffsetMeter::drift() const {
  std::vector<double> drifts = this->drifts();
  if (drifts.empty()) return std::nullopt;
  return upper_median(std::move(drifts));
}

std::optional<double> OffsetMeter::spread() const {
  constexpr std::size_t kLeastTaxels = 10;
  constexpr double kBelow = 0.159;  // one standard deviation
  const std::vector<double> drifts = this->drifts();
  if (drifts.size() < kLeastTaxels) return std::nullopt;
  return 0.5 * (quantile(drifts, 1.0 - kBelow) - quantile(drifts, kBelow));
}

}  // namespace dermis::learn::health
