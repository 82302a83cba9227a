// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/simulation/adc.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

namespace dermis::learn::simulation {
namespace {

std::vector<float> convert(const Readout& readout, double noise_lsb, const std::vector<double>& ratio, double supply_v,
                           std::uint64_t seed = 1) {
  Random random(seed);
  std::vector<float> counts(ratio.size());
  Adc(readout, noise_lsb).convert(ratio, supply_v, random, counts);
  return counts;
}

TEST(Adc, rounds_to_the_nearest_count) {
  const Readout ratiometric;
  const std::vector<double> ratio = {0.0, 0.49 / 4095.0, 0.51 / 4095.0, 2047.6 / 4095.0, 1.0};
  EXPECT_EQ(convert(ratiometric, 0.0, ratio, 3.7), (std::vector<float>{0, 0, 1, 2048, 4095}));
}

TEST(Adc, fixed_reference_follows_the_supply_and_ratiometric_does_not) {
  Readout fixed;
  fixed.adc_reference_v = 5.0;
  EXPECT_EQ(convert(fixed, 0.0, {0.5}, 4.0), (std::vector<float>{1638}));
  EXPECT_EQ(convert(fixed, 0.0, {0.5}, 5.0), (std::vector<float>{2048}));
  EXPECT_EQ(convert(Readout{}, 0.0, {0.5}, 4.0), (std::vector<float>{2048}));
}

TEST(Adc, clamps_to_its_range) {
  Readout readout;
  readout.adc_bits = 10;
  EXPECT_EQ(convert(readout, 0.0, {-0.2, 1.3}, 5.0), (std::vector<float>{0, 1023}));
  EXPECT_FALSE(std::signbit(convert(readout, 0.0, {-1e-6}, 5.0).front())) << "no ADC says -0";
}

TEST(Adc, offset_and_curve_change_what_is_sent) {
  Readout readout;
  readout.adc_errors.offset_counts = 10.0;
  readout.adc_errors.curve = {{0.0, 100.0}, {1000.0, 1100.0}, {3000.0, 2100.0}};
  const std::vector<double> ratio = {100.0 / 4095.0, 600.0 / 4095.0, 1600.0 / 4095.0, 2200.0 / 4095.0, 50.0 / 4095.0};
  EXPECT_EQ(convert(readout, 0.0, ratio, 5.0), (std::vector<float>{10, 510, 2010, 3110, 0}));
}

TEST(Adc, noise_has_the_asked_variance_on_top_of_the_rounding) {
  constexpr std::size_t kReadings = 100'000;
  const auto counts = convert(Readout{}, 2.0, std::vector<double>(kReadings, 1000.0 / 4095.0), 5.0);
  double mean = 0.0;
  double variance = 0.0;
  for (const float count : counts) mean += count / kReadings;
  for (const float count : counts) variance += (count - mean) * (count - mean) / kReadings;
  EXPECT_NEAR(mean, 1000.0, 5.0 * 2.0 / std::sqrt(kReadings));
  EXPECT_NEAR(variance, 4.0 + 1.0 / 12.0, 5.0 * 4.0 * std::sqrt(2.0 / kReadings));
}

TEST(Adc, same_seed_gives_the_same_counts) {
  const std::vector<double> ratio(100, 0.3);
  EXPECT_EQ(convert(Readout{}, 1.0, ratio, 5.0, 4), convert(Readout{}, 1.0, ratio, 5.0, 4));
  EXPECT_NE(convert(Readout{}, 1.0, ratio, 5.0, 4), convert(Readout{}, 1.0, ratio, 5.0, 5));
}

}  // namespace
}  // namespace dermis::learn::simulation
