// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "live/suits/waiting_frames.hpp"

#include <gtest/gtest.h>

namespace dermis::live::suits {
namespace {

void add(WaitingFrames& waiting, float count) {
  waiting.room().counts.assign(1, count);
  waiting.push();
}

TEST(WaitingFrames, come_in_order_however_many_there_are) {
  WaitingFrames waiting;
  EXPECT_TRUE(waiting.empty());
  float last = 0.0F;
  float next = 0.0F;
  for (const int more : {1, 3, 10, 2}) {
    for (int i = 0; i < more; ++i) add(waiting, last++);
    EXPECT_EQ(waiting.front().counts.front(), next++);
    waiting.pop();
  }
  EXPECT_EQ(waiting.size(), 12U);
  while (!waiting.empty()) {
    EXPECT_EQ(waiting.front().counts.front(), next++);
    waiting.pop();
  }
  EXPECT_EQ(next, last);
}

TEST(WaitingFrames, room_that_is_not_used_holds_no_frame) {
  WaitingFrames waiting;
  static_cast<void>(waiting.room());
  EXPECT_TRUE(waiting.empty());
  add(waiting, 5.0F);
  static_cast<void>(waiting.room());
  EXPECT_EQ(waiting.size(), 1U);
  EXPECT_EQ(waiting.front().counts.front(), 5.0F);
}

}  // namespace
}  // namespace dermis::live::suits
