// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/proposals/smoothness.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <random>
#include <vector>

#include "streams.hpp"

namespace dermis::bytes::proposals {
namespace {

std::vector<float> row_by_row(const test::Frame& frame) {
  return {frame.begin(), frame.end()};
}

/// An array that nobody touches, where one reading in twenty is a count more.
Readings untouched(std::size_t frames, std::size_t taxels, unsigned seed) {
  std::mt19937 random(seed);
  std::bernoulli_distribution is_more(0.05);
  Readings readings(frames, std::vector<float>(taxels));
  for (std::vector<float>& frame : readings) {
    for (float& reading : frame) reading = is_more(random) ? 5.0F : 4.0F;
  }
  return readings;
}

TEST(Smoothness, noise_does_not_turn_an_array) {
  int turned = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    turned += likely_shapes(untouched(6, 120, seed), 120, {}).front() == FrameShape{12, 10} ? 0 : 1;
  }
  EXPECT_LE(turned, 4);
}

TEST(Smoothness, a_press_tells_how_an_array_lies) {
  for (const FrameShape& shape : {FrameShape{10, 12}, FrameShape{12, 10}, FrameShape{8, 16}, FrameShape{16, 8}}) {
    Readings readings;
    for (const test::Frame& frame : test::pressed_frames(shape)) readings.push_back(row_by_row(frame));
    EXPECT_EQ(likely_shapes(readings, shape.taxel_count(), {}).front(), shape) << shape.rows << "x" << shape.cols;
  }
}

}  // namespace
}  // namespace dermis::bytes::proposals
