// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/recognition/comparison.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "simulated_touches.hpp"

namespace dermis::learn::recognition {
namespace {

struct Prepared {
  LabelledFrames data;
  LearningSet set;
  Learned learned;
};

Prepared prepared(LabelledFrames data) {
  Result<LearningSet> set = LearningSet::create(data);
  EXPECT_TRUE(set);
  Result<Learned> learned = set->learn(support::all_labels(data));
  EXPECT_TRUE(learned);
  return {std::move(data), *std::move(set), *std::move(learned)};
}

TEST(CompareEstimators, asks_each_what_the_recipe_is_asked) {
  const Prepared known = prepared(support::poses(20, 4, 5));
  std::size_t asked = 0;
  const ComparedEstimator first_class{"first class", [&](const Lesson& lesson) -> Result<std::vector<float>> {
                                        const std::size_t count = lesson.asked.size() / lesson.features;
                                        asked += count;
                                        EXPECT_EQ(lesson.taught.size(), lesson.class_of.size() * lesson.features);
                                        EXPECT_EQ(lesson.fold_of.size(), lesson.class_of.size());
                                        EXPECT_EQ(lesson.class_of.size() + count, known.data.labels.size());
                                        std::vector<float> answers(count * lesson.classes);
                                        for (std::size_t i = 0; i < count; ++i) answers[i * lesson.classes] = 1.0F;
                                        return answers;
                                      }};
  const auto figures = compare_estimators(known.data, known.set, known.learned, std::span(&first_class, 1));
  ASSERT_TRUE(figures);
  ASSERT_EQ(figures->size(), 3U);
  EXPECT_EQ(asked, known.learned.report.judged);
  EXPECT_EQ((*figures)[0].name, "dermis");
  EXPECT_EQ((*figures)[0].accuracy, known.learned.report.accuracy);
  EXPECT_EQ((*figures)[1].name, "nearest frame");
  EXPECT_FALSE((*figures)[1].calibration_error);
  EXPECT_EQ((*figures)[2].name, "first class");
  EXPECT_DOUBLE_EQ((*figures)[2].accuracy, 0.25);
  EXPECT_DOUBLE_EQ(*(*figures)[2].calibration_error, 0.75);
}

TEST(CompareEstimators, knows_the_frames_that_come_again) {
  LabelledFrames data = support::poses(4, 5);
  const std::size_t labels = data.labels.size();
  data.frames.insert(data.frames.end(), data.frames.begin(), data.frames.end());
  for (std::size_t i = 0; i < labels; ++i) {
    Label again = data.labels[i];
    data.labels[i].group = "before";
    again.id += "again";
    again.first = again.last = i + labels;
    again.group = "after";
    data.labels.push_back(again);
  }
  const Prepared known = prepared(std::move(data));
  const auto figures = compare_estimators(known.data, known.set, known.learned, {});
  ASSERT_TRUE(figures);
  EXPECT_EQ((*figures)[1].accuracy, 1.0);
}

TEST(CompareEstimators, features_of_a_lesson_are_standardised_by_what_is_taught) {
  const Prepared known = prepared(support::poses(20, 6));
  const ComparedEstimator look{"look", [](const Lesson& lesson) -> Result<std::vector<float>> {
                                 for (std::size_t column = 0; column < lesson.features; ++column) {
                                   double mean = 0.0;
                                   for (std::size_t i = 0; i < lesson.class_of.size(); ++i) {
                                     mean += static_cast<double>(lesson.taught[i * lesson.features + column]);
                                   }
                                   mean /= static_cast<double>(lesson.class_of.size());
                                   EXPECT_LT(std::abs(mean), 0.2);  // not 0: what lies far out is clipped
                                 }
                                 return bad_input("seen");
                               }};
  EXPECT_FALSE(compare_estimators(known.data, known.set, known.learned, std::span(&look, 1)));
}

}  // namespace
}  // namespace dermis::learn::recognition
