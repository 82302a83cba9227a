// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/recognition/frame_resampler.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <utility>
#include <vector>

#include "out/serve/named_touches.hpp"

namespace dermis::out::serve {
namespace {

/// What is used of frames of one taxel at these times, whose force is ten times their milliseconds.
std::vector<float> used(FrameResampler& resampler, const std::vector<std::int64_t>& milliseconds) {
  std::vector<float> all;
  for (const std::int64_t time : milliseconds) {
    resampler.take(force_frame(Nanos(1'000'000 * time), {static_cast<float>(10 * time)}),
                   [&](std::span<const float> newtons) { all.push_back(newtons[0]); });
  }
  return all;
}

TEST(FrameResampler, gives_forces_at_even_times_between_frames) {
  FrameResampler resampler(100.0, 1);
  EXPECT_EQ(used(resampler, {0, 4, 16, 33}), (std::vector<float>{0.0F, 100.0F, 200.0F, 300.0F}));
}

TEST(FrameResampler, gives_every_frame_where_no_rate_is_wanted) {
  FrameResampler resampler(0.0, 1);
  EXPECT_EQ(used(resampler, {0, 4, 16}), (std::vector<float>{0.0F, 40.0F, 160.0F}));
}

TEST(FrameResampler, a_taxel_that_says_nothing_has_no_load_and_spoils_no_other_frame) {
  constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();
  FrameResampler resampler(100.0, 1);
  std::vector<float> all;
  for (const auto& [time, newtons] : {std::pair{0, 1.0F}, {15, kNothing}, {30, 6.0F}, {45, 6.0F}}) {
    resampler.take(force_frame(Nanos(1'000'000LL * time), {newtons}),
                   [&](std::span<const float> one) { all.push_back(one[0]); });
  }
  ASSERT_EQ(all.size(), 5U);
  EXPECT_NEAR(all[1], 1.0 / 3.0, 1e-6);
  EXPECT_NEAR(all[2], 2.0, 1e-6);
  EXPECT_NEAR(all[3], 6.0, 1e-6);
}

TEST(FrameResampler, begins_anew_where_time_leaps) {
  FrameResampler resampler(100.0, 1);
  EXPECT_EQ(used(resampler, {0, 5, 9000, 9010, 100}), (std::vector<float>{0.0F, 90000.0F, 90100.0F, 1000.0F}));
  EXPECT_FALSE(resampler.leaps_to(force_frame(Nanos(110'000'000), {0.0F})));
  EXPECT_TRUE(resampler.leaps_to(force_frame(Nanos(90'000'000), {0.0F})));
}

}  // namespace
}  // namespace dermis::out::serve
