// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/faults/silence_evidence.hpp"

#include <cmath>
#include <numbers>

namespace dermis::touch::compensation {

// log P(floor | silent) / P(floor | mean) is not less than its second-order series.
FloorEvidence floor_evidence(double noise_counts) {
  const double floor = 0.5 / noise_counts;
  const double density = std::exp(-0.5 * floor * floor) / std::sqrt(2.0 * std::numbers::pi);
  const double below = 0.5 * std::erfc(-floor / std::numbers::sqrt2);
  const double slope = density / below;
  return {.sigmas = static_cast<float>(floor),
          .slope = static_cast<float>(slope),
          .curvature = static_cast<float>(0.5 * slope * (slope + floor)),
          .information = 0.5 * (density * (slope + floor) + 1.0 - below)};
}

}  // namespace dermis::touch::compensation
