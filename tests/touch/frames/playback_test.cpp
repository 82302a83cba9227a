// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/frames/playback.hpp"

#include <gtest/gtest.h>

namespace dermis {
namespace {

TEST(Playback, a_command_plays_on_at_the_recorded_pace_unless_it_says_more) {
  EXPECT_EQ(PlaybackCommand{}, (PlaybackCommand{.play = true, .speed = 1.0, .seek = std::nullopt}));
}

TEST(Playback, statuses_differ_by_state_time_and_speed) {
  const PlaybackStatus status;
  EXPECT_EQ(status, PlaybackStatus{});
  EXPECT_NE(status, (PlaybackStatus{.state = PlaybackStatus::State::ended}));
  EXPECT_NE(status, (PlaybackStatus{.now = Nanos(1)}));
  EXPECT_NE(status, (PlaybackStatus{.speed = 2.0}));
}

}  // namespace
}  // namespace dermis
