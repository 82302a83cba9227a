// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/out/datasets/frame_window.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "dermis/touch/frames/random.hpp"

namespace dermis::out::datasets {
namespace {

using std::chrono::milliseconds;

std::vector<Nanos> times_of(const FrameWindow& window) {
  std::vector<Nanos> times;
  for (const FrameWindow::Held& held : window.held()) times.push_back(held.time);
  return times;
}

TEST(FrameWindow, holds_the_last_frames_of_a_step_and_of_those_before) {
  FrameWindow window(3);
  for (const int time : {1, 2, 3, 4, 5}) EXPECT_TRUE(window.add(milliseconds(time)));
  window.step(milliseconds(2));
  EXPECT_EQ(times_of(window), (std::vector<Nanos>{milliseconds(1), milliseconds(2)}));
  EXPECT_EQ(window.fresh(), 2U);
  window.step(milliseconds(4));
  EXPECT_EQ(times_of(window), (std::vector<Nanos>{milliseconds(2), milliseconds(3), milliseconds(4)}));
  EXPECT_EQ(window.fresh(), 2U);
  EXPECT_EQ(window.missed(), 0U);
}

TEST(FrameWindow, counts_frames_that_no_window_holds) {
  FrameWindow window(1);
  for (const int time : {1, 2, 3}) EXPECT_TRUE(window.add(milliseconds(time)));
  window.step(milliseconds(3));
  EXPECT_EQ(window.missed(), 2U);
  EXPECT_FALSE(window.add(milliseconds(2)));
  EXPECT_EQ(window.missed(), 3U);
}

TEST(FrameWindow, keeps_no_more_frames_than_the_next_step_can_hold) {
  FrameWindow window(2);
  std::size_t most_slots = 0;
  for (int time = 1; time <= 1000; ++time) {
    most_slots = std::max(most_slots, window.add(milliseconds(time)).value() + 1);
    window.await(milliseconds(900));
  }
  EXPECT_EQ(most_slots, 102U) << "100 behind the step, and its window";
  window.step(milliseconds(900));
  EXPECT_EQ(times_of(window), (std::vector<Nanos>{milliseconds(899), milliseconds(900)}));
  EXPECT_EQ(window.fresh(), 2U);
  EXPECT_EQ(window.came(), 900U);
  EXPECT_EQ(window.missed(), 898U);
  window.step(milliseconds(901));
  EXPECT_EQ(window.came(), 1U);
  EXPECT_EQ(window.missed(), 898U);
}

TEST(FrameWindow, has_every_frame_once_among_the_fresh_ones_whatever_the_times) {
  Random random(45);
  for (int round = 0; round < 200; ++round) {
    const std::size_t length = 1 + random.below(6);
    FrameWindow window(length);
    std::map<std::size_t, Nanos> slots;
    std::vector<Nanos> came;
    std::vector<Nanos> seen;
    Nanos now{};
    for (int step = 0; step < 50; ++step) {
      for (std::uint64_t frames = random.below(8); frames > 0; --frames) {
        now += milliseconds(random.below(3));
        const auto slot = window.add(now);
        ASSERT_TRUE(slot);
        slots[*slot] = now;
        came.push_back(now);
      }
      now += milliseconds(1);
      if (random.below(2) == 0) window.await(now);
      window.step(now);
      ASSERT_LE(window.held().size(), length);
      ASSERT_EQ(window.held().size(), std::min(length, came.size()));
      for (std::size_t k = 0; k < window.held().size(); ++k) {
        const FrameWindow::Held& held = window.held()[k];
        EXPECT_EQ(slots[held.slot], held.time);  // the slot was not given away
        EXPECT_EQ(held.time, came[came.size() - window.held().size() + k]);
        if (k >= window.held().size() - window.fresh()) seen.push_back(held.time);
      }
    }
    EXPECT_EQ(seen.size() + window.missed(), came.size());
    EXPECT_TRUE(std::includes(came.begin(), came.end(), seen.begin(), seen.end()));
  }
}

}  // namespace
}  // namespace dermis::out::datasets
