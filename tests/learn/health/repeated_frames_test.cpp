// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/health/repeated_frames.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "dermis/touch/frames/random.hpp"

namespace dermis::learn::health {
namespace {

std::vector<float> noisy_frame(Random& random) {
  std::vector<float> counts;
  for (int taxel = 0; taxel < 64; ++taxel) counts.push_back(static_cast<float>(100 + random.below(5)));
  return counts;
}

TEST(RepeatedFrames, a_device_that_hangs_is_told_with_its_frames) {
  Random random(1);
  RepeatedFrames frames;
  for (int k = 0; k < 80; ++k) frames.add(noisy_frame(random));
  const std::vector<float> last = noisy_frame(random);
  for (int k = 0; k < 200; ++k) frames.add(last);
  EXPECT_EQ(frames.finding(), "frames 80 to 279 are all the same: the device, its wire or its reader hangs");
  EXPECT_EQ(frames.remark(), std::nullopt);
}

TEST(RepeatedFrames, frames_that_are_sent_three_times_are_stale) {
  Random random(2);
  RepeatedFrames frames;
  for (int k = 0; k < 80; ++k) {
    const std::vector<float> counts = noisy_frame(random);
    for (int again = 0; again < 3; ++again) frames.add(counts);
  }
  EXPECT_EQ(frames.finding(), std::nullopt);
  EXPECT_EQ(frames.remark(),
            "67 % of the frames repeat the one before: they are sent more often than they are measured");
}

TEST(RepeatedFrames, an_array_without_noise_may_rest) {
  RepeatedFrames frames;
  std::vector<float> counts(64, 3.0F);
  for (int k = 0; k < 1000; ++k) {
    counts[5] = k % 300 < 60 ? static_cast<float>(k % 60) : 3.0F;
    frames.add(counts);
  }
  EXPECT_EQ(frames.finding(), std::nullopt);
  EXPECT_EQ(frames.remark(), std::nullopt);
}

TEST(RepeatedFrames, a_readout_that_cuts_off_what_nothing_presses_does_not_hang) {
  Random random(3);
  RepeatedFrames frames;
  for (int k = 0; k < 400; ++k) {
    frames.add(k / 200 == 0 ? noisy_frame(random) : std::vector<float>(64, 0.0F));
  }
  EXPECT_EQ(frames.finding(), std::nullopt);
  EXPECT_EQ(frames.remark(), std::nullopt);
}

}  // namespace
}  // namespace dermis::learn::health
