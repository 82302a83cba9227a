// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "learn/recognition/learning/folds.hpp"

#include <gtest/gtest.h>

#include <map>
#include <set>

namespace dermis::learn::recognition {
namespace {

std::vector<Label> labels_of(const std::vector<std::string>& groups) {
  std::vector<Label> labels;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    labels.push_back({std::to_string(i), i, i, "", groups[i], static_cast<double>(i)});
  }
  return labels;
}

TEST(Folds, keep_groups_whole) {
  std::vector<std::string> groups;
  std::vector<std::size_t> classes;
  for (std::size_t i = 0; i < 70; ++i) {
    groups.push_back(std::to_string(i % 7));
    classes.push_back(i / 7 % 2);
  }
  const Folds folds = make_folds(labels_of(groups), classes, Deal::in_turns);
  EXPECT_EQ(folds.kind, Folds::Kind::by_group);
  EXPECT_EQ(folds.count, 7U);
  std::map<std::string, std::set<std::size_t>> folds_of_group;
  for (std::size_t i = 0; i < groups.size(); ++i) folds_of_group[groups[i]].insert(folds.fold_of[i]);
  for (const auto& [group, used] : folds_of_group) EXPECT_EQ(used.size(), 1U) << group;
}

TEST(Folds, go_by_time_where_each_class_is_of_one_group) {
  const Folds folds = make_folds(labels_of({"a", "a", "a", "b", "b", "b"}), {0, 0, 0, 1, 1, 1}, Deal::in_turns);
  EXPECT_EQ(folds.kind, Folds::Kind::by_time);
}

TEST(Folds, go_by_time_where_one_group_holds_nearly_everything) {
  std::vector<std::string> groups(465, "a");
  groups.resize(481, "b");
  std::vector<std::size_t> classes;
  for (std::size_t i = 0; i < groups.size(); ++i) classes.push_back(i % 10);
  const Folds folds = make_folds(labels_of(groups), classes, Deal::in_turns);
  EXPECT_EQ(folds.kind, Folds::Kind::by_time);
  EXPECT_EQ(folds.count, 10U);
}

TEST(Folds, keep_groups_whole_that_leave_a_quarter_of_each_class) {
  for (const std::size_t of_second : {9U, 10U}) {
    std::vector<std::string> groups(40 - of_second, "a");
    groups.resize(40, "b");
    const Folds folds = make_folds(labels_of(groups), std::vector<std::size_t>(40, 0), Deal::in_turns);
    EXPECT_EQ(folds.kind, of_second == 10 ? Folds::Kind::by_group : Folds::Kind::by_time) << of_second;
  }
}

TEST(Folds, go_by_time_where_some_label_names_no_group) {
  const Folds folds = make_folds(labels_of({"a", "b", "", "b"}), {0, 0, 1, 1}, Deal::in_runs);
  EXPECT_EQ(folds.kind, Folds::Kind::by_time);
}

TEST(Folds, are_runs_in_order_of_time_of_each_class) {
  std::vector<Label> labels = labels_of(std::vector<std::string>(20));
  std::vector<std::size_t> classes;
  for (std::size_t i = 0; i < 20; ++i) {
    labels[i].order = -static_cast<double>(i);
    classes.push_back(i % 2);
  }
  const Folds folds = make_folds(labels, classes, Deal::in_runs);
  EXPECT_EQ(folds.count, 5U);
  for (std::size_t i = 2; i < 20; ++i) EXPECT_LE(folds.fold_of[i], folds.fold_of[i - 2]);
  EXPECT_EQ(folds.fold_of[19], 0U);
  EXPECT_EQ(folds.fold_of[0], 4U);
}

TEST(Folds, in_turns_see_all_times) {
  const Folds folds =
      make_folds(labels_of(std::vector<std::string>(40)), std::vector<std::size_t>(40, 0), Deal::in_turns);
  EXPECT_EQ(folds.count, 10U);
  for (std::size_t i = 10; i < 40; ++i) EXPECT_EQ(folds.fold_of[i], folds.fold_of[i - 10]);
  EXPECT_NE(folds.fold_of[0], folds.fold_of[1]);
}

TEST(Folds, part_the_examples_of_a_class_that_has_two) {
  const Folds folds = make_folds(labels_of({"", "", "", ""}), {0, 0, 1, 1}, Deal::in_runs);
  EXPECT_NE(folds.fold_of[0], folds.fold_of[1]);
  EXPECT_NE(folds.fold_of[2], folds.fold_of[3]);
}

}  // namespace
}  // namespace dermis::learn::recognition
