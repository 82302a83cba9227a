// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "live/fleet/followed_session.hpp"

#include <gtest/gtest.h>

#include <chrono>

namespace dermis::live::fleet {
namespace {

using Answer = FollowedSession::Answer;
using std::chrono::seconds;

TEST(MessageId, says_the_session_and_the_frames) {
  const MessageId id = parse_message_id(begin_of_id(12, "left-hand") + "400.20");
  EXPECT_EQ(id.session, 12U);
  EXPECT_EQ(id.first, 400U);
  EXPECT_EQ(id.frames, 20U);
  EXPECT_EQ(parse_message_id(begin_of_id(12, "chest") + "d3.99").session, 12U);
  EXPECT_EQ(parse_message_id(begin_of_id(12, "chest") + "d3.99").frames, 0U);
}

TEST(MessageId, of_others_says_nothing) {
  for (const char* text :
       {"", "s", "s.", "s-1.2", "1764495914000chest-12", "s99999999999999999999.a-1.2", "sx.a-1.2"}) {
    EXPECT_EQ(parse_message_id(text).session, 0U) << text;
    EXPECT_EQ(parse_message_id(text).frames, 0U) << text;
  }
  EXPECT_EQ(parse_message_id("s1.a-1.99999999999999999999").frames, 0U);
}

TEST(FollowedSession, follows_the_later_process_and_passes_over_the_earlier) {
  FollowedSession session;
  EXPECT_EQ(session.take({.session = 5}, seconds(0)), Answer::same);
  EXPECT_EQ(session.take({.session = 9}, seconds(1)), Answer::next);
  EXPECT_EQ(session.take({.session = 5}, seconds(2)), Answer::other);
  EXPECT_EQ(session.take({.session = 0}, seconds(2)), Answer::other);
  EXPECT_EQ(session.take({.session = 9}, seconds(3)), Answer::same);
}

TEST(FollowedSession, follows_an_earlier_number_where_nothing_came_for_long) {
  FollowedSession session;
  EXPECT_EQ(session.take({.session = 9}, seconds(0)), Answer::same);
  EXPECT_EQ(session.take({.session = 1}, seconds(9)), Answer::other);
  EXPECT_EQ(session.take({.session = 1}, seconds(10)), Answer::next);  // its server has lost its store of names
}

TEST(FollowedSession, knows_what_is_missing) {
  FollowedSession session;
  const MessageId first{.session = 5, .first = 100, .frames = 20};
  EXPECT_EQ(session.take(first, {}), Answer::same);
  EXPECT_EQ(session.missing_before(first), 0U);  // it was not read from the beginning
  session.pass(first);
  const MessageId later{.session = 5, .first = 150, .frames = 20};
  EXPECT_EQ(session.missing_before(later), 30U);
  session.pass(later);
  const MessageId restarted{.session = 6, .first = 7, .frames = 1};
  EXPECT_EQ(session.take(restarted, {}), Answer::next);
  EXPECT_EQ(session.missing_before(restarted), 7U);
}

}  // namespace
}  // namespace dermis::live::fleet
