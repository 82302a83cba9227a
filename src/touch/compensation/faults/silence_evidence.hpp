// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

namespace dermis::touch::compensation {

inline constexpr float kMostMean = 8.0F;  // beyond, less than half of this many deviations show silence

/// Evidence of a reading at the floor of the ADC, by the noise of a reading.
struct FloorEvidence {
  float sigmas = 0.0F;       // readings below half a count are the floor
  float slope = 0.0F;        // log P(floor | silent) / P(floor | mean), to second order in the mean:
  float curvature = 0.0F;    // the least that it can be
  double information = 0.0;  // mean evidence of a silent taxel over the squared expected reading
};

/// `noise_counts`: standard deviation of a reading, rounding included.
[[nodiscard]] FloorEvidence floor_evidence(double noise_counts);

/// Log-likelihood ratio of a silent taxel against one that reads `expected`, or more [standard deviations]. The noise
/// is Gaussian, cut off at the floor of the ADC: readings below `floor_end`.
inline float silence_evidence(float reading, float expected, float floor_end, const FloorEvidence& floor, float most) {
  constexpr float kMostAgainst = -20.0F;
  const float mean = expected < kMostMean ? expected : kMostMean;
  const float above = mean * (0.5F * mean - reading);
  const float at_floor = mean * (floor.slope + floor.curvature * mean);
  const float ratio = reading < floor_end ? at_floor : above;
  const float limited = ratio < most ? ratio : most;
  return limited > kMostAgainst ? limited : kMostAgainst;
}

}  // namespace dermis::touch::compensation
