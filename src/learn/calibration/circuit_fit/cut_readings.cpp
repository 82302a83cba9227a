// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/circuit_fit/cut_readings.hpp"

#include <cmath>
#include <numbers>

namespace dermis::learn::calibration {

double trusted_above(const CircuitFrame& frame) {
  constexpr double kMostNoise = 0.7;  // of a mean, over the described one of a reading
  constexpr double kCutSigmas = 2.0;  // from here on a cut moves the mean by less than 0.01 sigma
  return frame.sigma_ratio < kMostNoise * frame.described_sigma ? kCutSigmas * frame.described_sigma : 0.0;
}

double mean_above(double cut, double mean, double sigma) {
  const double t = (mean - cut) / sigma;
  const double density = std::exp(-0.5 * t * t) / std::sqrt(2.0 * std::numbers::pi);
  return cut + sigma * (t * 0.5 * std::erfc(-t / std::numbers::sqrt2) + density);
}

}  // namespace dermis::learn::calibration
