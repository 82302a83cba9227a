// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/recognition/predictions.hpp"

#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

#include "simulated_touches.hpp"

namespace dermis::learn::recognition {
namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

/// One split that asks for the first label of each kind and learns from all others.
Split one_split(const LabelledFrames& data) {
  Split split{"one", support::all_labels(data), {}};
  for (std::size_t kind = 0; kind < support::kPoses; ++kind) split.asked.push_back(kind);
  split.taught.erase(split.taught.begin(), split.taught.begin() + support::kPoses);
  return split;
}

TEST(PredictionsOf, have_a_line_for_each_label_that_is_asked_for) {
  const LabelledFrames data = support::poses(8, 3);
  const Result<LearningSet> set = LearningSet::create(data);
  ASSERT_TRUE(set);
  std::vector<double> shares;
  const std::vector<Split> splits(2, one_split(data));
  const auto text =
      predictions_of(data, *set, splits, Answers::classes, [&](double share) { shares.push_back(share); });
  ASSERT_TRUE(text) << text.error().message;
  const std::vector<std::string> lines = lines_of(*text);
  ASSERT_EQ(lines.size(), 1 + 2 * support::kPoses);
  EXPECT_EQ(lines[0], "split,id,class,probability");
  for (std::size_t kind = 0; kind < support::kPoses; ++kind) {
    const std::string begin = "one,p" + std::to_string(kind) + "," + support::pose_name(kind) + ",";
    EXPECT_EQ(lines[1 + kind].rfind(begin, 0), 0U) << lines[1 + kind];
  }
  EXPECT_EQ(shares, (std::vector<double>{0.5, 1.0}));
}

TEST(PredictionsOf, say_unknown_of_a_class_that_was_not_learned) {
  LabelledFrames data = support::poses(12, 4);
  const Result<LearningSet> set = LearningSet::create(data);
  ASSERT_TRUE(set);
  Split split{"open", {}, {}};
  for (std::size_t i = 0; i < data.labels.size(); ++i) {
    (i % support::kPoses == 3 ? split.asked : split.taught).push_back(i);
  }
  const auto open = predictions_of(data, *set, std::span(&split, 1), Answers::classes_or_unknown);
  ASSERT_TRUE(open) << open.error().message;
  EXPECT_EQ(lines_of(*open).front(), "split,id,class,probability,unknown_score");
  EXPECT_NE(open->find(",unknown,"), std::string::npos) << *open;
  const auto closed = predictions_of(data, *set, std::span(&split, 1), Answers::classes);
  ASSERT_TRUE(closed);
  EXPECT_EQ(closed->find("unknown"), std::string::npos) << *closed;
}

TEST(PredictionsOf, name_the_split_that_nothing_can_be_learned_from) {
  const LabelledFrames data = support::poses(4, 5);
  const Result<LearningSet> set = LearningSet::create(data);
  ASSERT_TRUE(set);
  const Split split{"empty", {}, {0}};
  const auto text = predictions_of(data, *set, std::span(&split, 1), Answers::classes);
  ASSERT_FALSE(text);
  EXPECT_EQ(text.error().message.rfind("split 'empty': ", 0), 0U) << text.error().message;
}

}  // namespace
}  // namespace dermis::learn::recognition
