// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/out/datasets/step_plan.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "dermis/out/datasets/frame_window.hpp"
#include "dermis/touch/frames/random.hpp"

namespace dermis::out::datasets {
namespace {

using std::chrono::milliseconds;

/// Fresh frames of each step of 150 Hz at 30 Hz, whose times have this jitter [ns].
std::vector<std::size_t> fresh_of_jittered(std::int64_t jitter_ns) {
  constexpr std::size_t kWindow = 5;
  constexpr double kNanosPerFrame = 1e9 / 150.0;
  Random random(7);
  StepPlan plan(1, kWindow, 30.0);
  FrameWindow window(kWindow);
  std::vector<std::size_t> fresh;
  for (int frame = 0; frame < 3000; ++frame) {
    const auto noise = static_cast<std::int64_t>(random.uniform(-1.0, 1.0) * static_cast<double>(jitter_ns));
    const Nanos time(static_cast<std::int64_t>(frame * kNanosPerFrame) + noise);
    plan.see(0, time);
    EXPECT_TRUE(window.add(time));
    for (const Nanos step : plan.take_due(frame == 2999)) {
      window.step(step);
      fresh.push_back(window.fresh());
      EXPECT_LE(window.held().back().time, step);
    }
  }
  EXPECT_EQ(window.missed(), 0U);
  return fresh;
}

TEST(StepPlan, has_five_new_frames_of_150_hz_in_each_step_of_30_hz_with_jitter_too) {
  for (const std::int64_t jitter_ns : {0, 1'000'000}) {
    const std::vector<std::size_t> fresh = fresh_of_jittered(jitter_ns);
    EXPECT_EQ(fresh.size(), 600U);
    EXPECT_TRUE(std::all_of(fresh.begin(), fresh.end(), [](std::size_t count) { return count == 5; }));
  }
}

TEST(StepPlan, says_the_steps_of_a_clock_without_a_drift) {
  EXPECT_EQ(step_time(Nanos(5), 30.0, 1), Nanos(33'333'338));
  EXPECT_EQ(step_time(Nanos(5), 30.0, 3'000'000), Nanos(5) + std::chrono::seconds(100'000));
}

TEST(StepPlan, waits_for_the_slowest_array_but_not_for_a_silent_one) {
  StepPlan plan(2, 1, 100.0);
  for (int frame = 0; frame <= 50; ++frame) plan.see(0, milliseconds(10 * frame));
  EXPECT_TRUE(plan.take_due(false).empty());
  plan.see(1, milliseconds(200));
  EXPECT_EQ(plan.take_due(false).back(), milliseconds(195));
  for (int frame = 51; frame <= 150; ++frame) plan.see(0, milliseconds(10 * frame));
  EXPECT_EQ(plan.take_due(false).back(), milliseconds(495));
  EXPECT_EQ(plan.take_due(true).back(), milliseconds(1505));
  EXPECT_TRUE(plan.take_due(false).empty());
}

TEST(StepPlan, has_one_step_where_there_is_one_frame) {
  StepPlan plan(1, 5, 30.0);
  EXPECT_TRUE(plan.take_due(true).empty());
  plan.see(0, milliseconds(70));
  EXPECT_EQ(plan.take_due(true), (std::vector<Nanos>{milliseconds(70)}));
}

TEST(StepPlan, takes_given_times) {
  StepPlan plan(1, {milliseconds(5), milliseconds(6), milliseconds(9)});
  plan.see(0, milliseconds(6));
  EXPECT_EQ(plan.take_due(false), (std::vector<Nanos>{milliseconds(5)}));
  EXPECT_EQ(plan.take_due(true), (std::vector<Nanos>{milliseconds(6), milliseconds(9)}));
}

}  // namespace
}  // namespace dermis::out::datasets
