// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/step_budget.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <vector>

namespace dermis::touch::compensation {
namespace {

constexpr double kMost = 64.0;
constexpr double kEach = 1.0;

/// Of a frame that goes on as long as it may.
int steps_of_a_frame(StepBudget& budget, double share = 1.0) {
  budget.start_frame({});
  budget.start_attempt(share);
  int steps = 0;
  while (steps < 10000 && budget.take(1.0)) ++steps;
  return steps;
}

void solve_frames(StepBudget& budget, int frames, double work) {
  for (int frame = 0; frame < frames; ++frame) {
    budget.start_frame({});
    ASSERT_TRUE(budget.take(work));
    budget.learn();
  }
}

TEST(StepBudget, without_a_most_nothing_is_bounded) {
  StepBudget budget(0.0, kEach);
  EXPECT_EQ(steps_of_a_frame(budget), 10000);
}

TEST(StepBudget, a_hard_frame_after_easy_ones_takes_what_they_have_saved) {
  StepBudget budget(kMost, kEach);
  solve_frames(budget, 100, 4.0);
  EXPECT_EQ(steps_of_a_frame(budget), 64);
}

TEST(StepBudget, any_hundred_frames_take_little_more_than_good_ones) {
  StepBudget budget(kMost, kEach);
  solve_frames(budget, 100, 4.0);
  std::vector<int> steps;
  for (int frame = 0; frame < 1000; ++frame) steps.push_back(steps_of_a_frame(budget));
  int most = 0;
  for (std::size_t first = 0; first + 100 <= steps.size(); ++first) {
    int sum = 0;
    for (std::size_t frame = first; frame < first + 100; ++frame) sum += steps[frame];
    most = std::max(most, sum);
  }
  EXPECT_LE(most, 64 + 100 * 9);
  EXPECT_GE(steps.back(), 8) << "twice a good frame";
}

TEST(StepBudget, an_array_whose_frames_are_hard_has_the_work_that_they_take) {
  StepBudget budget(kMost, kEach);
  solve_frames(budget, 1000, 40.0);
}

TEST(StepBudget, what_bad_frames_have_taken_is_saved_again) {
  StepBudget budget(kMost, kEach);
  solve_frames(budget, 100, 4.0);
  for (int frame = 0; frame < 10; ++frame) steps_of_a_frame(budget);
  EXPECT_TRUE(budget.is_scarce());
  solve_frames(budget, 30, 4.0);
  EXPECT_FALSE(budget.is_scarce());
  EXPECT_EQ(steps_of_a_frame(budget), 64);
}

TEST(StepBudget, a_first_attempt_leaves_some_for_others) {
  StepBudget budget(kMost, kEach);
  EXPECT_EQ(steps_of_a_frame(budget, 0.5), 32);
  budget.start_attempt(1.0);
  EXPECT_TRUE(budget.take(30.0));
  EXPECT_FALSE(budget.take(3.0));
}

TEST(StepBudget, work_that_is_refused_is_left_to_the_next_attempt) {
  StepBudget budget(kMost, kEach);
  budget.start_frame({});
  EXPECT_FALSE(budget.take(kMost + 1.0));
  EXPECT_TRUE(budget.is_used_up());
  budget.start_attempt(1.0);
  EXPECT_TRUE(budget.take(kMost));
}

TEST(StepBudget, work_that_had_to_be_done_is_owed_by_the_next_frames) {
  StepBudget budget(kMost, kEach);
  solve_frames(budget, 100, 4.0);
  EXPECT_EQ(steps_of_a_frame(budget), 64);
  budget.start_frame({});
  budget.spend(9.0 + 2.0 * kEach);
  EXPECT_EQ(steps_of_a_frame(budget), 7);
}

TEST(StepBudget, frames_that_come_less_often_take_more) {
  StepBudget budget(kMost, kEach);
  for (int frame = 0; frame < 8; ++frame) steps_of_a_frame(budget);
  const auto steps_after = [&](Nanos since_last) {
    budget.start_frame(since_last);
    int steps = 0;
    while (budget.take(1.0)) ++steps;
    budget.start_frame({});
    while (budget.take(1.0)) continue;
    return steps;
  };
  EXPECT_EQ(steps_after(std::chrono::milliseconds(1)), 1);
  EXPECT_EQ(steps_after(std::chrono::milliseconds(3)), 3);
  EXPECT_EQ(steps_after(std::chrono::hours(1)), 8);
}

TEST(StepBudget, what_is_forgotten_bounds_nothing) {
  StepBudget budget(kMost, kEach);
  for (int frame = 0; frame < 8; ++frame) steps_of_a_frame(budget);
  budget.forget();
  EXPECT_EQ(steps_of_a_frame(budget), 64);
}

}  // namespace
}  // namespace dermis::touch::compensation
