// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/recognition/learning.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "simulated_touches.hpp"

namespace dermis::learn::recognition {
namespace {

Result<Learned> learn(const LabelledFrames& data) {
  const Result<LearningSet> set = LearningSet::create(data);
  if (!set) return set.error();
  return set->learn(support::all_labels(data));
}

std::string error_of(const LabelledFrames& data) {
  const Result<Learned> learned = learn(data);
  if (learned) return "no error";
  EXPECT_EQ(learned.error().kind, ErrorKind::bad_input);
  return learned.error().message;
}

TEST(LearningSet, learns_poses_from_ten_examples_each) {
  const Result<Learned> learned = learn(support::poses(10, 1));
  ASSERT_TRUE(learned) << learned.error().message;
  EXPECT_EQ(learned->classes.names, (std::vector<std::string>{"large", "long", "small", "two"}));
  EXPECT_EQ(learned->classes.examples, (std::vector<std::int64_t>{10, 10, 10, 10}));
  EXPECT_FALSE(learned->classes.moving);
  EXPECT_TRUE(learned->classes.validate());
  EXPECT_GE(learned->report.accuracy, 0.9);
  EXPECT_EQ(learned->report.judged, 40U);
  const auto& confusion = learned->report.confusion;
  EXPECT_EQ(std::accumulate(confusion.begin(), confusion.end(), std::size_t{0}), 40U);
}

TEST(LearningSet, learns_gestures_of_one_place_by_how_they_move) {
  const Result<Learned> learned = learn(support::gestures(8, 2));
  ASSERT_TRUE(learned) << learned.error().message;
  EXPECT_TRUE(learned->classes.moving);
  EXPECT_GE(learned->report.accuracy, 0.9);
}

TEST(LearningSet, gives_the_same_classes_again) {
  const Result<Learned> first = learn(support::poses(5, 3));
  const Result<Learned> second = learn(support::poses(5, 3));
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->classes, second->classes);
}

TEST(LearningSet, holds_out_whole_sessions_where_the_labels_name_them) {
  const Result<Learned> by_session = learn(support::poses(9, 4, 3));
  ASSERT_TRUE(by_session);
  EXPECT_TRUE(by_session->report.by_group);
  EXPECT_EQ(by_session->report.folds, 3U);
  const Result<Learned> by_time = learn(support::poses(9, 4));
  ASSERT_TRUE(by_time);
  EXPECT_FALSE(by_time->report.by_group);
  EXPECT_EQ(by_time->report.folds, 5U);
}

TEST(LearningSet, learns_where_the_other_sessions_know_one_class_alone) {
  LabelledFrames data = support::poses(4, 12);
  std::erase_if(data.labels, [](const Label& label) { return label.name == "long" && label.first >= 8; });
  for (Label& label : data.labels) {
    label.group = label.name == "two" ? "all are small" : "of every kind";
    if (label.name == "two") label.name = "small";
  }
  const Result<Learned> learned = learn(data);
  ASSERT_TRUE(learned) << learned.error().message;
  EXPECT_TRUE(learned->report.by_group);
  const Status valid = learned->classes.validate();
  ASSERT_TRUE(valid) << valid.error().message;
  const auto is_even = [&](const Expert& expert) { return expert.unknown_weight == learned->classes.doubt_weight; };
  EXPECT_FALSE(std::ranges::all_of(learned->classes.experts, is_even)) << "nothing was learned";
}

TEST(LearningSet, learns_from_the_chosen_labels_alone) {
  const LabelledFrames data = support::poses(10, 5);
  const Result<LearningSet> set = LearningSet::create(data);
  ASSERT_TRUE(set);
  std::vector<std::size_t> without_two;
  for (const std::size_t label : support::all_labels(data)) {
    if (data.labels[label].name != "two") without_two.push_back(label);
  }
  const Result<Learned> learned = set->learn(without_two);
  ASSERT_TRUE(learned) << learned.error().message;
  EXPECT_EQ(learned->classes.names, (std::vector<std::string>{"large", "long", "small"}));
}

TEST(LearningSet, two_examples_of_two_classes_are_enough) {
  LabelledFrames data = support::poses(2, 6);
  for (Label& label : data.labels) label.name = label.name == "two" ? "two" : "one";
  EXPECT_EQ(error_of(data), "no error");
}

TEST(LearningSet, refuses_what_nothing_can_be_learned_from) {
  LabelledFrames data = support::poses(2, 7);
  data.labels.pop_back();
  EXPECT_EQ(error_of(data), "class 'two' has one example; give it two or more, or leave it out");
  for (const std::size_t label : {0U, 3U, 4U}) data.labels[label].name = "unknown";
  EXPECT_EQ(error_of(data), "class 'unknown' is the answer for what is like no class; give it another name");
  for (Label& label : data.labels) label.name = "any";
  EXPECT_EQ(error_of(data), "all examples are of class 'any'; two classes or more are needed");
  data.labels.clear();
  EXPECT_EQ(error_of(data), "there is no example to learn from");
}

TEST(LearningSet, refuses_ten_thousand_classes) {
  LabelledFrames data;
  data.layout = support::one_array(1, 2);
  for (std::size_t i = 0; i < 10000; ++i) {
    data.frames.insert(data.frames.end(), {1.0F, 2.0F});
    data.labels.push_back({std::to_string(i), i, i, "class " + std::to_string(i), "", 0.0});
  }
  EXPECT_EQ(error_of(data), "there are 10000 classes; at most 1000 can be learned");
}

TEST(LearningSet, refuses_examples_that_are_all_the_same) {
  LabelledFrames data = support::poses(3, 8);
  std::fill(data.frames.begin(), data.frames.end(), 0.0F);
  EXPECT_EQ(error_of(data), "all examples are the same; are the frames the right ones?");
}

TEST(LearningSet, tells_how_far_it_is) {
  double last = 0.0;
  const Result<LearningSet> set = LearningSet::create(support::poses(3, 9), [&](double share) {
    EXPECT_GT(share, last);
    last = share;
  });
  ASSERT_TRUE(set);
  EXPECT_EQ(last, 1.0);
}

TEST(Advice, asks_for_examples_where_there_are_few) {
  const Result<Learned> learned = learn(support::poses(4, 10));
  ASSERT_TRUE(learned);
  const std::vector<std::string> lines = advice(*learned);
  const auto asks = [](const std::string& line) { return line == "long needs more examples: it has 4, fewer than 5"; };
  EXPECT_TRUE(std::any_of(lines.begin(), lines.end(), asks));
}

TEST(Advice, names_the_two_classes_that_are_confused) {
  Learned learned;
  learned.classes.names = {"cup", "ball", "pen"};
  learned.classes.examples = {10, 10, 10};
  learned.report.confusion = {9, 1, 0, 3, 7, 0, 0, 0, 10};
  learned.report.confused = ConfusedPair{0, 1, 4, {{"force", 0.5}, {"shape", 0.755}}};
  const std::vector<std::string> lines = advice(learned);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines[0],
            "cup and ball are confused most: 4 of 20 examples; guessing tells 50 % apart, force alone 50 %, "
            "shape alone 76 %");
}

TEST(Advice, says_that_sessions_are_too_lopsided_to_be_held_out) {
  LabelledFrames data = support::poses(20, 13);
  for (std::size_t i = 0; i < data.labels.size(); ++i) data.labels[i].group = i < 72 ? "long" : "short";
  const Result<Learned> learned = learn(data);
  ASSERT_TRUE(learned);
  EXPECT_FALSE(learned->report.by_group);
  EXPECT_GE(learned->report.accuracy, 0.9);
  const std::vector<std::string> lines = advice(*learned);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines[0],
            "the folds are by class, not by subject or session: most classes would have had too few examples left (the "
            "largest subject or session has 72 of 80); what another one gives is not known");
}

TEST(Advice, asks_for_another_session_of_a_class_that_nearly_all_comes_from_one) {
  Learned learned;
  learned.classes.names = {"ball", "cup"};
  learned.classes.examples = {47, 40};
  learned.report.by_group = true;
  learned.report.groups = 2;
  learned.report.confusion = {1, 46, 0, 40};
  learned.report.in_one_fold = {46, 20};
  const std::vector<std::string> lines = advice(learned);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines[0],
            "ball needs examples of another subject or session: 46 of 47 are held out at once, so its figures tell "
            "little");
}

/// Two patterns of each class, none of which lies between those of the other: no plane parts them.
LabelledFrames crossed(std::size_t count) {
  Random random(5);
  LabelledFrames data;
  data.layout = support::one_array(2, 2);
  for (std::size_t i = 0; i < count; ++i) {
    const bool upper = i % 4 < 2;
    const bool left = i % 2 == 0;
    std::vector<float> frame{left ? 90.0F : 10.0F, 10.0F, upper ? 90.0F : 10.0F, 60.0F};
    for (float& reading : frame) reading += static_cast<float>(4.0 * random.normal());
    data.frames.insert(data.frames.end(), frame.begin(), frame.end());
    data.labels.push_back(
        {"p" + std::to_string(i), i, i, upper == left ? "same" : "other", "", static_cast<double>(i)});
  }
  return data;
}

TEST(LearningSet, learns_patterns_of_few_taxels_that_no_plane_parts) {
  for (const std::size_t count : {80U, 800U}) {  // all of them are centres of kernels, then some
    const Result<Learned> learned = learn(crossed(count));
    ASSERT_TRUE(learned);
    EXPECT_GE(learned->report.accuracy, 0.98) << count;
    const Expert& kernels = learned->classes.experts.back();
    EXPECT_EQ(kernels.name, "course");
    EXPECT_EQ(kernels.influences.size(), 2 * std::min<std::size_t>(count, 512));
  }
}

/// Poses of one shape, anywhere, that are pressed lightly or hard: now and then a light one is the harder.
LabelledFrames light_and_hard(std::uint64_t seed) {
  Random random(seed);
  LabelledFrames data;
  data.layout = support::one_array(12, 10);
  for (std::size_t i = 0; i < 80; ++i) {
    const bool is_hard = i % 2 == 1;
    std::vector<float> frame(data.layout.readings);
    const double force = (is_hard ? 1500.0 : 1000.0) + 250.0 * random.normal();
    support::press(frame, 12, 10, 1.0, {random.uniform(4.0, 8.0), random.uniform(4.0, 6.0), 1.2, 1.2, force});
    data.frames.insert(data.frames.end(), frame.begin(), frame.end());
    data.labels.push_back({"p" + std::to_string(i), i, i, is_hard ? "hard" : "light", "", static_cast<double>(i)});
  }
  return data;
}

TEST(LearningSet, tells_by_what_two_classes_are_confused) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE(seed);
    const Result<Learned> learned = learn(light_and_hard(seed));
    ASSERT_TRUE(learned);
    ASSERT_TRUE(learned->report.confused);
    const ConfusedPair& pair = *learned->report.confused;
    EXPECT_EQ(pair.first + pair.second, 1U);
    EXPECT_EQ(pair.mistakes, learned->report.confusion[1] + learned->report.confusion[2]);
    ASSERT_EQ(pair.aspects.size(), 4U);
    EXPECT_EQ(pair.aspects.back().name, "force");
    EXPECT_GE(pair.aspects.back().discrimination, 0.75);
    EXPECT_LE(pair.aspects.front().discrimination, 0.65);
  }
}

TEST(LearningSet, names_no_two_classes_where_none_are_confused) {
  const Result<Learned> learned = learn(support::poses(20, 1));
  ASSERT_TRUE(learned);
  ASSERT_EQ(learned->report.accuracy, 1.0);
  EXPECT_FALSE(learned->report.confused);
}

TEST(Advice, warns_of_a_single_session) {
  const Result<Learned> learned = learn(support::poses(6, 11, 1));
  ASSERT_TRUE(learned);
  const std::vector<std::string> lines = advice(*learned);
  const auto warns = [](const std::string& line) { return line.starts_with("all examples are of one subject"); };
  EXPECT_TRUE(std::any_of(lines.begin(), lines.end(), warns));
}

}  // namespace
}  // namespace dermis::learn::recognition
