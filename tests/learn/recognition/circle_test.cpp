// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/recognition/features/circle.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace dermis::learn::recognition {
namespace {

TEST(Circle, begins_at_angle_zero_and_goes_round) {
  const Circle<8> circle;
  EXPECT_EQ(circle.cosine(0), 1.0);
  EXPECT_EQ(circle.sine(0), 0.0);
  EXPECT_NEAR(circle.cosine(2), 0.0, 1e-15);
  EXPECT_NEAR(circle.sine(2), 1.0, 1e-15);
  EXPECT_EQ(circle.sine(2 + 3 * 8), circle.sine(2));
  EXPECT_EQ(circle.cosine(3 + 8), circle.cosine(3));
}

TEST(Circle, has_the_power_of_a_wave_in_its_harmonic_alone) {
  const Circle<16> circle;
  std::vector<double> wave;
  for (std::size_t i = 0; i < 16; ++i) wave.push_back(0.5 + circle.sine(3 * i + 1));
  EXPECT_NEAR(circle.power(wave, 0), 64.0, 1e-9);  // (16 * 0.5)^2
  EXPECT_NEAR(circle.power(wave, 3), 64.0, 1e-9);  // (16 / 2)^2
  EXPECT_NEAR(circle.power(wave, 2), 0.0, 1e-9);
}

TEST(Circle, takes_values_that_are_missing_for_0) {
  const Circle<4> circle;
  EXPECT_EQ(circle.power(std::vector<double>{1.0}, 1), circle.power(std::vector<double>{1.0, 0.0, 0.0, 0.0}, 1));
  EXPECT_EQ(circle.power({}, 1), 0.0);
}

}  // namespace
}  // namespace dermis::learn::recognition
