// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "touch/compensation/step_budget.hpp"

#include <gtest/gtest.h>

namespace dermis::touch::compensation {
namespace {

constexpr int kMuch = 8 * 12;

int steps_of_a_frame(StepBudget& budget) {
  budget.start_frame();
  int steps = 0;
  while (steps < 10000 && budget.take(1.0)) ++steps;
  return steps;
}

TEST(StepBudget, without_a_least_nothing_is_bounded) {
  StepBudget budget(0.0);
  EXPECT_EQ(steps_of_a_frame(budget), 10000);
}

TEST(StepBudget, a_hard_frame_after_easy_ones_takes_what_it_needs) {
  StepBudget budget(12.0);
  for (int frame = 0; frame < 100; ++frame) {
    budget.start_frame();
    ASSERT_TRUE(budget.take(4.0));
    budget.learn();
  }
  EXPECT_EQ(steps_of_a_frame(budget), kMuch);
}

TEST(StepBudget, frames_that_are_not_solved_take_a_few_times_what_solved_frames_took) {
  StepBudget budget(12.0);
  budget.start_frame();
  ASSERT_TRUE(budget.take(4.0));
  budget.learn();
  for (int frame = 0; frame < 4; ++frame) EXPECT_EQ(steps_of_a_frame(budget), kMuch) << frame;
  int with_much = 0;
  for (int frame = 4; frame < 132; ++frame) with_much += steps_of_a_frame(budget) == 22 ? 0 : 1;
  EXPECT_EQ(with_much, 2) << "tried again";
}

TEST(StepBudget, another_attempt_at_a_frame_is_bounded) {
  StepBudget budget(12.0);
  budget.start_frame(0.5);
  EXPECT_FALSE(budget.take(7.0));
}

TEST(StepBudget, what_is_forgotten_bounds_nothing) {
  StepBudget budget(12.0);
  for (int frame = 0; frame < 8; ++frame) steps_of_a_frame(budget);
  budget.forget();
  EXPECT_EQ(steps_of_a_frame(budget), kMuch);
}

}  // namespace
}  // namespace dermis::touch::compensation
