// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/recognition/touch_finder.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "dermis/touch/frames/random.hpp"

namespace dermis::learn::recognition {
namespace {

constexpr TouchLimits kLimits{.onset = 10.0, .release_share = 0.3, .gap_frames = 3};

TEST(TouchFinder, finds_a_touch_from_onset_to_release) {
  const std::vector<double> forces{0, 1, 0, 50, 80, 70, 60, 2, 0, 1, 0, 0};
  EXPECT_EQ(find_touches(kLimits, forces), (std::vector<Touch>{{3, 6}}));
}

TEST(TouchFinder, bridges_gaps_shorter_than_the_release_gap) {
  EXPECT_EQ(find_touches(kLimits, std::vector<double>{0, 50, 0, 0, 50, 0, 0, 0, 50, 0, 0, 0}),
            (std::vector<Touch>{{1, 4}, {8, 8}}));
}

TEST(TouchFinder, gives_a_touch_as_soon_as_the_gap_is_over) {
  TouchFinder finder(kLimits);
  for (const double force : {0.0, 50.0, 0.0, 0.0}) EXPECT_FALSE(finder.next(force));
  EXPECT_TRUE(finder.is_touched());
  EXPECT_EQ(finder.next(0.0), (Touch{1, 1}));
  EXPECT_FALSE(finder.is_touched());
}

TEST(TouchFinder, holds_a_touch_however_long_it_lasts) {
  std::vector<double> forces(500, 40.0);
  forces[0] = 0.0;
  EXPECT_EQ(find_touches(kLimits, forces), (std::vector<Touch>{{1, 499}}));
}

TEST(TouchFinder, follows_an_idle_level_that_drifts) {
  std::vector<double> forces;
  for (std::size_t i = 0; i < 300; ++i)
    forces.push_back(static_cast<double>(i) * 0.3 + (i >= 200 && i < 210 ? 50.0 : 0.0));
  EXPECT_EQ(find_touches(kLimits, forces), (std::vector<Touch>{{200, 209}}));
}

TEST(TouchFinder, does_not_wait_for_what_a_touch_leaves_behind) {
  std::vector<double> forces(40, 0.0);
  for (std::size_t i = 5; i < 40; ++i) forces[i] = 12.0;  // the skin does not come back to 0
  for (std::size_t i = 5; i < 15; ++i) forces[i] = 100.0;
  for (std::size_t i = 25; i < 30; ++i) forces[i] = 90.0;
  EXPECT_EQ(find_touches(kLimits, forces), (std::vector<Touch>{{5, 14}, {25, 29}}));
}

TEST(TouchFinder, adds_the_frames_around_but_never_gives_one_twice) {
  TouchLimits limits = kLimits;
  limits.before_frames = 2;
  limits.after_frames = 5;
  EXPECT_EQ(find_touches(limits, std::vector<double>{0, 50, 0, 0, 0, 50, 50, 0, 0}),
            (std::vector<Touch>{{0, 4}, {5, 8}}));
}

TEST(TouchLimits, are_learned_from_labels) {
  Random random(1);
  std::vector<double> forces;
  std::vector<Touch> labels;
  for (int touch = 0; touch < 30; ++touch) {
    for (int i = 0; i < 12; ++i) forces.push_back(20.0 + random.normal());
    const Touch pressed{forces.size(), forces.size() + 7};
    for (int i = 0; i < 8; ++i) forces.push_back(20.0 + random.uniform(60.0, 90.0));
    labels.push_back({pressed.first - 2, pressed.last + 1});
  }
  for (int i = 0; i < 12; ++i) forces.push_back(20.0 + random.normal());
  const TouchLimits limits = learn_touch_limits(forces, labels);
  EXPECT_TRUE(limits.validate());
  EXPECT_EQ(find_touches(limits, forces), labels);
}

TEST(Finding, is_judged_by_intersection_over_union) {
  const std::vector<Touch> labels{{0, 9}, {20, 29}, {40, 49}};
  const FindingReport report = judge_finding(labels, std::vector<Touch>{{5, 14}, {22, 29}, {60, 61}});
  EXPECT_EQ(report.labelled, 3U);
  EXPECT_EQ(report.found, 1U);
  EXPECT_EQ(report.others, 1U);
}

TEST(TouchLimits, name_what_is_out_of_range) {
  TouchLimits limits = kLimits;
  EXPECT_TRUE(limits.validate());
  limits.onset = std::nan("");
  EXPECT_EQ(limits.validate().error().message, "onset: must be above 0");
  limits = kLimits;
  limits.gap_frames = 0;
  EXPECT_EQ(limits.validate().error().message, "gap_frames: must be 1 to 1000");
}

}  // namespace
}  // namespace dermis::learn::recognition
