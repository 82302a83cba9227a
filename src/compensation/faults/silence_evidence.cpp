// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "compensation/faults/silence_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dermis::compensation {
namespace {

constexpr double kRoundingVariance = 1.0 / 12;  // [counts^2]
constexpr double kLeastNoise = 0.02;            // before rounding [counts]

}  // namespace

// Neither the second-order series nor the bound of the normal distribution's tail is more than the logarithm.
FloorEvidence floor_evidence(double noise_counts) {
  const double noise = std::sqrt(std::max(noise_counts * noise_counts - kRoundingVariance, kLeastNoise * kLeastNoise));
  const double per_sigma = noise_counts / noise;
  const double floor = 0.5 / noise;
  const double density = std::exp(-0.5 * floor * floor) / std::sqrt(2.0 * std::numbers::pi);
  const double below = 0.5 * std::erfc(-floor / std::numbers::sqrt2);
  const double slope = density / below;
  return {.sigmas = static_cast<float>(0.5 / noise_counts),
          .slope = static_cast<float>(per_sigma * slope),
          .curvature = static_cast<float>(per_sigma * per_sigma * 0.5 * slope * (slope + floor)),
          .above = static_cast<float>(std::log(2.0 * below)),
          .steepness = static_cast<float>(0.5 * per_sigma * per_sigma),
          .share = below,
          .rest = density / per_sigma};
}

}  // namespace dermis::compensation
