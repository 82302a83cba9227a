// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/recording/last_minute.hpp"

#include <gtest/gtest.h>

#include <chrono>

namespace dermis::out::serve {
namespace {

using std::chrono::seconds;

constexpr Nanos kInterval = std::chrono::milliseconds(100);

RawFrame frame(std::int64_t number, std::size_t taxels = 4) {
  RawFrame frame;
  frame.time = number * kInterval;
  frame.supply_v = 5.0;
  frame.acquisition.sequence = static_cast<std::uint64_t>(number);
  frame.counts.assign(taxels, static_cast<float>(number % 4096));
  return frame;
}

std::vector<RawFrame> all_of(const LastMinute& minute, std::size_t array = 0) {
  return minute.frames(array, Nanos::min(), Nanos::max());
}

TEST(LastMinute, keeps_a_minute_of_frames_with_every_bit) {
  LastMinute minute(1);
  for (std::int64_t number = 0; number < 2000; ++number) minute.keep(0, frame(number));
  const std::vector<RawFrame> kept = all_of(minute);
  ASSERT_EQ(kept.size(), 601U);
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const RawFrame expected = frame(static_cast<std::int64_t>(1399 + i));
    EXPECT_EQ(kept[i].time, expected.time);
    EXPECT_EQ(kept[i].counts, expected.counts);
    EXPECT_EQ(kept[i].supply_v, expected.supply_v);
    EXPECT_EQ(kept[i].acquisition, expected.acquisition);
  }
}

TEST(LastMinute, keeps_fractions_and_counts_that_are_not_whole) {
  LastMinute minute(1);
  RawFrame fractions = frame(0);
  fractions.counts = {0.5F, -1.0F, 1e6F, 3.0F};
  minute.keep(0, fractions);
  minute.keep(0, frame(1));
  EXPECT_EQ(all_of(minute).front().counts, fractions.counts);
  EXPECT_EQ(all_of(minute).back().counts, frame(1).counts);
}

TEST(LastMinute, gives_a_selection) {
  LastMinute minute(2);
  for (std::int64_t number = 0; number < 500; ++number) minute.keep(1, frame(number));
  const std::vector<RawFrame> selected = minute.frames(1, seconds(10), seconds(20));
  ASSERT_EQ(selected.size(), 101U);
  EXPECT_EQ(selected.front().time, seconds(10));
  EXPECT_EQ(selected.back().time, seconds(20));
  EXPECT_TRUE(minute.frames(0, seconds(10), seconds(20)).empty());
}

TEST(LastMinute, holds_no_more_than_its_memory) {
  LastMinute minute(2);
  constexpr std::size_t kTaxels = std::size_t{128} * 128;
  for (std::int64_t number = 0; number < 400; ++number) minute.keep(0, frame(number, kTaxels));
  const std::size_t bytes = all_of(minute).size() * kTaxels * sizeof(std::uint16_t);
  EXPECT_LE(bytes, LastMinute::kMostBytes / 2);
  EXPECT_GE(bytes, LastMinute::kMostBytes / 3);
}

TEST(LastMinute, begins_anew_where_a_playback_is_put_back) {
  LastMinute minute(1);
  for (const std::int64_t number : {100, 101, 5, 6}) minute.keep(0, frame(number));
  EXPECT_EQ(all_of(minute).size(), 2U);
  EXPECT_EQ(all_of(minute).front().time, 5 * kInterval);
}

}  // namespace
}  // namespace dermis::out::serve
