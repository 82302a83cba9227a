// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "live/buses/followed_sender.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>

namespace dermis::live::buses {
namespace {

using std::chrono::hours;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Nanos kStart{1'700'000'000'000'000'000};

/// A topic of frames that come 10 ms after one another, unless it is told another time.
class FollowedSenderTest : public ::testing::Test {
 protected:
  bool takes(std::uint8_t writer, Nanos since_start, Nanos wait = milliseconds(10)) {
    arrival_ += wait;
    return sender_.objection({writer}, kStart + since_start, arrival_).empty();
  }

  Nanos arrival_ = hours(5);
  FollowedSender sender_;
};

TEST_F(FollowedSenderTest, one_of_two_senders_is_followed) {
  for (int k = 0; k < 500; ++k) {
    EXPECT_TRUE(takes(1, milliseconds(20 * k))) << k;
    EXPECT_FALSE(takes(2, milliseconds(20 * k + 10))) << k;
  }
}

TEST_F(FollowedSenderTest, a_sender_that_is_started_again_is_followed_once_the_other_is_silent) {
  EXPECT_TRUE(takes(1, milliseconds(0)));
  EXPECT_FALSE(takes(2, milliseconds(500), milliseconds(500)));
  EXPECT_TRUE(takes(2, milliseconds(1000), milliseconds(500)));
  EXPECT_FALSE(takes(1, milliseconds(1010)));
  EXPECT_TRUE(takes(2, milliseconds(1020)));
}

TEST_F(FollowedSenderTest, a_sender_whose_clock_was_set_back_is_followed_after_a_second) {
  EXPECT_TRUE(takes(1, hours(1)));
  int left_out = 0;
  while (!takes(1, milliseconds(10 * left_out))) ++left_out;
  EXPECT_EQ(left_out, 99);
  EXPECT_TRUE(takes(1, milliseconds(1000)));
}

TEST_F(FollowedSenderTest, one_time_that_goes_back_or_leaps_ahead_costs_its_frame_alone) {
  EXPECT_TRUE(takes(1, seconds(100)));
  EXPECT_TRUE(takes(1, seconds(100))) << "a frame that is shown again";
  EXPECT_FALSE(takes(1, seconds(99)));
  EXPECT_FALSE(takes(1, seconds(120)));
  EXPECT_FALSE(takes(1, Nanos::max() - kStart));
  EXPECT_TRUE(takes(1, seconds(105))) << "others may have been lost on a slow network";
}

TEST_F(FollowedSenderTest, no_time_is_beyond_what_can_be_counted_with) {
  for (const Nanos since_start :
       {Nanos::max() - kStart, Nanos(-1) - kStart, Nanos::min(), Nanos(hours(24 * 365 * 90))}) {
    EXPECT_FALSE(takes(1, since_start)) << since_start.count();
  }
  EXPECT_TRUE(takes(1, -kStart));
}

TEST_F(FollowedSenderTest, a_slow_sender_is_followed) {
  for (int k = 0; k < 100; ++k) EXPECT_TRUE(takes(1, seconds(60 * k), seconds(60))) << k;
}

}  // namespace
}  // namespace dermis::live::buses
