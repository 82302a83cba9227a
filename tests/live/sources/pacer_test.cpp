// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/sources/pacer.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <thread>

namespace dermis::live::sources {
namespace {

using namespace std::chrono_literals;  // NOLINT(google-build-using-namespace): the literals only

TEST(DueAfter, is_the_time_between_at_that_speed) {
  EXPECT_EQ(due_after(5s, 7s), 2s);
  EXPECT_EQ(due_after(5s, 7s, 4.0), 500ms);
  EXPECT_EQ(due_after(5s, 7s, 0.5), 4s);
}

TEST(DueAfter, is_at_once_for_times_that_go_back) {
  EXPECT_EQ(due_after(7s, 5s), 0s);
}

TEST(DueAfter, is_bounded_whatever_the_times) {
  EXPECT_EQ(due_after(Nanos::min(), Nanos::max()), Nanos(1'000'000'000'000'000'000));
  EXPECT_EQ(due_after(Nanos::max(), Nanos::min()), 0s);
}

TEST(Pacer, waits_until_the_moment_has_come) {
  Pacer pacer(nullptr);
  EXPECT_TRUE(pacer.wait_until(150ms));
  EXPECT_GE(pacer.elapsed(), 150ms);
}

TEST(Pacer, stops_where_the_flag_is_set_even_if_the_moment_has_come) {
  const std::atomic<bool> stop = true;
  Pacer pacer(&stop);
  EXPECT_FALSE(pacer.wait_until(0s));
}

TEST(Pacer, stops_where_the_flag_is_set_while_it_waits) {
  std::atomic<bool> stop = false;
  Pacer pacer(&stop);
  const std::jthread setter([&] { stop = true; });
  EXPECT_FALSE(pacer.wait_until(24h));
}

}  // namespace
}  // namespace dermis::live::sources
