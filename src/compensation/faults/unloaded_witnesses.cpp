// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "compensation/faults/unloaded_witnesses.hpp"

#include <algorithm>
#include <span>

#include "compensation/faults/silence_evidence.hpp"
#include "dermis/core/touch.hpp"

namespace dermis::compensation {
namespace {

constexpr double kNoiseSigmas = 5.0;
constexpr int kFramesOfDistrust = 200;

}  // namespace

void UnloadedWitnesses::follow(const ConditionedFrame& conditioned, const UnloadedTaxels& unloaded,
                               const FaultList& faults) noexcept {
  const std::span<const double> ratio = conditioned.ratio;
  const double sigma = conditioned.sigma_ratio;
  std::size_t unpressed = 0;
  std::size_t expected = 0;
  std::size_t reading = 0;
  for (std::size_t taxel = 0; taxel < ratio.size(); ++taxel) {
    if (faults.causes(taxel) != 0) continue;
    if (ratio[taxel] > touched_above(unloaded.ratio()[taxel], sigma, kNoiseSigmas)) continue;
    const auto least = static_cast<double>(std::min(unloaded.least_reading()[taxel], kMostMean));
    ++unpressed;
    if (least > 0.0) ++expected;
    if (least > 0.0 && ratio[taxel] > 0.5 * least * sigma) ++reading;
  }
  if (2 * unpressed > ratio.size() && 2 * reading < expected) {
    distrust_ = kFramesOfDistrust;
  } else if (2 * reading > unpressed && distrust_ > 0) {
    --distrust_;
  }
}

}  // namespace dermis::compensation
