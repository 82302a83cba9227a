// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "compensation/step_budget.hpp"

#include <gtest/gtest.h>

namespace dermis::compensation {
namespace {

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

TEST(StepBudget, frames_take_a_few_times_what_solved_frames_took) {
  StepBudget budget(12.0);
  budget.start_frame();
  ASSERT_TRUE(budget.take(4.0));
  budget.learn();
  EXPECT_EQ(steps_of_a_frame(budget), 22);
}

TEST(StepBudget, frames_that_are_never_solved_do_not_take_more_and_more) {
  StepBudget budget(12.0);
  for (int frame = 0; frame < 8; ++frame) EXPECT_EQ(steps_of_a_frame(budget), 10000) << "nothing is known yet";
  for (int frame = 0; frame < 8; ++frame) EXPECT_EQ(steps_of_a_frame(budget), 12);
}

}  // namespace
}  // namespace dermis::compensation
