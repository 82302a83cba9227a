// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/calibration/circuit_fit/cut_readings.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "dermis/touch/frames/random.hpp"

namespace dermis::learn::calibration {
namespace {

TEST(CutReadings, have_the_mean_that_many_draws_show) {
  constexpr std::uint64_t kSeed = 5;
  constexpr int kDraws = 200000;
  constexpr double kSigma = 0.3;
  SCOPED_TRACE(kSeed);
  Random random(kSeed);
  for (const double mean : {-0.5, 0.0, 0.2, 1.0}) {
    double sum = 0.0;
    for (int k = 0; k < kDraws; ++k) sum += std::max(0.1, mean + kSigma * random.normal());
    EXPECT_NEAR(mean_above(0.1, mean, kSigma), sum / kDraws, 5.0 * kSigma / std::sqrt(kDraws));
  }
  EXPECT_NEAR(mean_above(0.0, 0.0, kSigma), kSigma / std::sqrt(2.0 * std::numbers::pi), 1e-12);
}

TEST(CutReadings, of_means_tell_nothing_near_0_and_single_ones_do) {
  CircuitFrame frame;
  frame.described_sigma = frame.sigma_ratio = 1e-3;
  EXPECT_EQ(trusted_above(frame), 0.0);
  frame.sigma_ratio = 1e-4;
  EXPECT_EQ(trusted_above(frame), 2e-3);
}

}  // namespace
}  // namespace dermis::learn::calibration
