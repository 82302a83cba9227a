// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/learn/arrangement/press_guide.hpp"

#include <gtest/gtest.h>

#include "learn/arrangement/board.hpp"

namespace dermis::learn::arrangement {
namespace {

using testing::Board;

void play(PressGuide& guide, const std::vector<int>& pressed) {
  for (const RawFrame& frame : Board{.before_s = 1.5}.frames(pressed)) guide.add(frame.counts, frame.time);
}

TEST(PressGuide, goes_from_place_to_place) {
  PressGuide guide(3);
  EXPECT_FALSE(guide.is_ready());
  play(guide, {5, 2, 9});
  EXPECT_TRUE(guide.is_done());
  EXPECT_EQ(guide.answers()[0]->channel, 5U);
  EXPECT_EQ(guide.answers()[1]->channel, 2U);
  EXPECT_EQ(guide.answers()[2]->channel, 9U);
  EXPECT_NEAR(guide.most_counts(), 810.0, 20.0);
}

TEST(PressGuide, asks_again_where_a_channel_has_answered_already) {
  PressGuide guide(3);
  play(guide, {5, 5});
  EXPECT_EQ(guide.place(), 1U);
  EXPECT_EQ(guide.repeated(), 0U);
}

TEST(PressGuide, believes_a_channel_that_answers_again_and_again) {
  PressGuide guide(3);
  play(guide, {5, 5, 5, 2});
  EXPECT_TRUE(guide.is_done());
  EXPECT_EQ(guide.answers()[1]->channel, 5U);
  EXPECT_EQ(guide.answers()[2]->channel, 2U);
}

TEST(PressGuide, skips_and_goes_back) {
  PressGuide guide(2);
  guide.skip();
  EXPECT_EQ(guide.place(), 1U);
  guide.back();
  guide.back();
  EXPECT_EQ(guide.place(), 0U);
  guide.skip();
  play(guide, {4});
  EXPECT_TRUE(guide.is_done());
  EXPECT_FALSE(guide.answers()[0].has_value());
  guide.skip();
  EXPECT_TRUE(guide.is_done());
}

}  // namespace
}  // namespace dermis::learn::arrangement
