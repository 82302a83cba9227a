// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "live/sources/contact_loop.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "live/sources/small_array.hpp"
#include "support/allocation_guard.hpp"

namespace dermis::live::sources {
namespace {

constexpr double kMostNoise = 16.0;  // [counts] of two readings, each of 1 count standard deviation

ContactLoop loop_of(std::uint64_t seed, std::size_t frames) {
  Result<ContactLoop> loop = ContactLoop::create(small_array(), seed, frames);
  EXPECT_TRUE(loop) << loop.error().message;
  return *std::move(loop);
}

RawFrame read_at(ContactLoop& loop, double seconds) {
  RawFrame frame;
  loop.read(seconds, frame);
  return frame;
}

/// [counts]
double largest_difference(const RawFrame& first, const RawFrame& second) {
  double largest = 0.0;
  for (std::size_t i = 0; i < first.counts.size(); ++i) {
    largest = std::max(largest, static_cast<double>(std::abs(first.counts[i] - second.counts[i])));
  }
  return largest;
}

TEST(ContactLoop, gives_the_same_frames_for_the_same_seed) {
  ContactLoop first = loop_of(3, 50);
  ContactLoop second = loop_of(3, 50);
  ContactLoop other = loop_of(4, 50);
  for (const double seconds : {0.0, 0.123, 7.5}) {
    const RawFrame frame = read_at(first, seconds);
    const RawFrame same = read_at(second, seconds);
    EXPECT_EQ(frame.counts, same.counts);
    EXPECT_EQ(frame.temperature_celsius, same.temperature_celsius);
    EXPECT_EQ(frame.supply_v, same.supply_v);
    EXPECT_NE(frame.counts, read_at(other, seconds).counts);
  }
}

TEST(ContactLoop, begins_again_after_its_length_with_fresh_noise) {
  ContactLoop loop = loop_of(1, 200);  // 2 s
  for (const double seconds : {0.1, 0.905, 1.37}) {
    const RawFrame frame = read_at(loop, seconds);
    const RawFrame later = read_at(loop, seconds + 4.0);
    EXPECT_NE(frame.counts, later.counts);
    EXPECT_LT(largest_difference(frame, later), kMostNoise) << seconds;
  }
}

TEST(ContactLoop, shows_contacts_that_come_and_go) {
  ContactLoop loop = loop_of(1, 200);
  const RawFrame unloaded = read_at(loop, 0.1);
  double largest = 0.0;
  for (double seconds = 0.3; seconds < 1.7; seconds += 0.1) {
    largest = std::max(largest, largest_difference(read_at(loop, seconds), unloaded));
  }
  EXPECT_GT(largest, 3.0 * kMostNoise);
}

TEST(ContactLoop, moves_evenly_between_the_frames_of_the_scene) {
  ContactLoop loop = loop_of(2, 200);
  for (double seconds = 0.3; seconds < 1.7; seconds += 0.1) {
    const RawFrame before = read_at(loop, seconds);
    const RawFrame between = read_at(loop, seconds + 0.005);
    const RawFrame after = read_at(loop, seconds + 0.01);
    for (std::size_t i = 0; i < between.counts.size(); ++i) {
      const double middle = 0.5 * static_cast<double>(before.counts[i] + after.counts[i]);
      EXPECT_NEAR(between.counts[i], middle, kMostNoise) << seconds << " s, taxel " << i;
    }
  }
}

TEST(ContactLoop, allocates_nothing_after_the_first_frame) {
  if (!support::kAllocationsAreCounted) GTEST_SKIP() << "the sanitizer owns malloc";
  ContactLoop loop = loop_of(1, 20);
  RawFrame frame;
  loop.read(0.0, frame);
  const support::AllocationGuard guard;
  for (int i = 1; i < 100; ++i) loop.read(0.003 * i, frame);
  EXPECT_EQ(guard.count(), 0U);
}

TEST(ContactLoop, refuses_a_scene_without_frames) {
  const Result<ContactLoop> loop = ContactLoop::create(small_array(), 1, 0);
  ASSERT_FALSE(loop);
  EXPECT_NE(loop.error().message.find("frames"), std::string::npos) << loop.error().message;
}

}  // namespace
}  // namespace dermis::live::sources
