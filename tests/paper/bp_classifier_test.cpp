// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/paper/bp_classifier.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "dermis/touch/frames/random.hpp"

namespace dermis::paper {
namespace {

constexpr std::uint64_t kSeed = 11;
constexpr std::size_t kClasses = 3;

/// Points around one centre a class in the plane, in `folds` folds; the centres are asked.
learn::recognition::Lesson lesson_of(std::size_t folds) {
  constexpr float kCentres[kClasses][2] = {{-1.0F, -1.0F}, {1.0F, -1.0F}, {0.0F, 1.5F}};
  Random random(kSeed);
  learn::recognition::Lesson lesson;
  lesson.features = 2;
  lesson.classes = kClasses;
  for (std::size_t i = 0; i < 90; ++i) {
    for (const float centre : kCentres[i % kClasses]) {
      lesson.taught.push_back(centre + static_cast<float>(0.2 * random.normal()));
    }
    lesson.class_of.push_back(i % kClasses);
    lesson.fold_of.push_back(i / kClasses % folds);
  }
  for (const auto& centre : kCentres) lesson.asked.insert(lesson.asked.end(), centre, centre + 2);
  return lesson;
}

void expect_right_answers(const learn::recognition::Lesson& lesson) {
  const auto answers = answer_by_bp_network(lesson);
  ASSERT_TRUE(answers) << answers.error().message;
  ASSERT_EQ(answers->size(), kClasses * kClasses);
  for (std::size_t asked = 0; asked < kClasses; ++asked) {
    const auto row = answers->begin() + static_cast<std::ptrdiff_t>(asked * kClasses);
    EXPECT_NEAR(std::accumulate(row, row + kClasses, 0.0F), 1.0F, 1e-5F);
    EXPECT_EQ(static_cast<std::size_t>(std::max_element(row, row + kClasses) - row), asked) << "seed " << kSeed;
  }
}

TEST(AnswerByBpNetwork, shares_1_among_the_classes_and_finds_the_right_one) {
  expect_right_answers(lesson_of(5));
}

TEST(AnswerByBpNetwork, holds_out_some_examples_where_all_are_of_one_fold) {
  expect_right_answers(lesson_of(1));
}

TEST(AnswerByBpNetwork, answers_the_same_each_time) {
  const learn::recognition::Lesson lesson = lesson_of(4);
  EXPECT_EQ(*answer_by_bp_network(lesson), *answer_by_bp_network(lesson));
}

}  // namespace
}  // namespace dermis::paper
