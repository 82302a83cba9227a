// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/recognition/evaluation.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "small_classes.hpp"

namespace dermis::learn::recognition {
namespace {

TEST(EvaluateClasses, counts_what_is_answered_to_poses_that_were_not_learned_from) {
  const Result<ClassesEvaluation> evaluation = evaluate_classes(support::small_classes(), support::poses(20, 99));
  ASSERT_TRUE(evaluation) << evaluation.error().message;
  ASSERT_EQ(evaluation->confusion.size(), support::kPoses * support::kPoses);
  EXPECT_EQ(evaluation->judged, 20 * support::kPoses);
  EXPECT_EQ(std::accumulate(evaluation->confusion.begin(), evaluation->confusion.end(), std::size_t{0}),
            evaluation->judged);
  std::size_t right = 0;
  for (std::size_t label = 0; label < support::kPoses; ++label) {
    right += evaluation->confusion[label * (support::kPoses + 1)];
  }
  EXPECT_EQ(evaluation->accuracy, static_cast<double>(right) / static_cast<double>(evaluation->judged));
  EXPECT_GE(evaluation->accuracy, 0.95);
  EXPECT_LE(evaluation->calibration_error, 0.1);
  EXPECT_EQ(evaluation->others, 0U);
}

TEST(EvaluateClasses, counts_classes_that_were_not_learned_apart) {
  LabelledFrames data = support::poses(10, 98);
  for (Label& label : data.labels) {
    if (label.name == "long") label.name = "never learned";
  }
  const Result<ClassesEvaluation> evaluation = evaluate_classes(support::small_classes(), data);
  ASSERT_TRUE(evaluation) << evaluation.error().message;
  EXPECT_EQ(evaluation->judged, 30U);
  EXPECT_EQ(evaluation->others, 10U);
  EXPECT_LE(evaluation->others_unknown, 10U);
}

TEST(EvaluateClasses, refuses_what_cannot_be_judged) {
  LabelledFrames data = support::poses(5, 97);
  for (Label& label : data.labels) label.name = "never learned";
  EXPECT_FALSE(evaluate_classes(support::small_classes(), data));
  EXPECT_FALSE(evaluate_classes(support::small_classes(), support::gestures(2, 1)));
}

}  // namespace
}  // namespace dermis::learn::recognition
