// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

namespace dermis::compensation {

inline constexpr float kMostMean = 8.0F;  // beyond, silence is told by less than half of this many deviations

/// What a reading at the floor of the ADC says. Noise moves a reading to and from the floor; rounding does not, as it
/// does the same in every frame.
struct FloorEvidence {
  float sigmas = 0.0F;  // readings below half a count are the floor
  // log P(floor | silent) / P(floor | mean), at least: to second order in the mean,
  float slope = 0.0F;
  float curvature = 0.0F;
  float above = 0.0F;  // and where the mean is above the floor
  float steepness = 0.0F;
  double share = 0.0;  // of the readings of a silent taxel that are the floor,
  double rest = 0.0;   // and the mean of the others, times their share [standard deviations]

  [[nodiscard]] float of_floor(float mean) const {
    const float to_second_order = mean * (slope + curvature * mean);
    const float beyond = mean - sigmas;
    const float in_tail = beyond > 0.0F ? above + steepness * beyond * beyond : 0.0F;
    return to_second_order > in_tail ? to_second_order : in_tail;
  }

  /// Mean evidence of a silent taxel.
  [[nodiscard]] double of_silence(double mean) const {
    return share * static_cast<double>(of_floor(static_cast<float>(mean))) + mean * (0.5 * mean * (1.0 - share) - rest);
  }
};

/// `noise_counts`: standard deviation of a reading, rounding included.
[[nodiscard]] FloorEvidence floor_evidence(double noise_counts);

/// Log-likelihood ratio of a silent taxel against one that reads `expected`, or more [standard deviations]: Gaussian
/// noise, cut off at the floor of the ADC, where readings below `floor_end` are.
inline float silence_evidence(float reading, float expected, float floor_end, const FloorEvidence& floor, float most) {
  constexpr float kMostAgainst = -20.0F;
  const float mean = expected < kMostMean ? expected : kMostMean;
  const float above = mean * (0.5F * mean - reading);
  const float ratio = reading < floor_end ? floor.of_floor(mean) : above;
  const float limited = ratio < most ? ratio : most;
  return limited > kMostAgainst ? limited : kMostAgainst;
}

}  // namespace dermis::compensation
