// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "live/sources/simulated_device.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

namespace dermis::live::sources {
namespace {

using namespace std::chrono_literals;  // NOLINT(google-build-using-namespace): the literals only

constexpr FrameShape kShape{1, 1};

/// The number of the frame is its only count.
void count(std::uint64_t number, RawFrame& frame) {
  frame.counts.assign(1, static_cast<float>(number));
}

RawFrame next_of(FrameSource& source) {
  RawFrame frame;
  const Result<bool> more = source.next(frame);
  EXPECT_TRUE(more && *more);
  return frame;
}

TEST(SimulatedDevice, is_live_and_tells_its_shape) {
  const SimulatedDevice device(count, kShape, 100.0, nullptr);
  EXPECT_TRUE(device.is_live());
  EXPECT_EQ(device.shape(), kShape);
  EXPECT_EQ(device.statistics(), SourceStatistics{});
}

TEST(SimulatedDevice, stamps_its_frames_with_number_and_time) {
  SimulatedDevice device(count, kShape, 250.0, nullptr);
  const Nanos begin = next_of(device).time;
  for (int i = 0; i < 10; ++i) {
    const RawFrame frame = next_of(device);
    const auto number = static_cast<std::int64_t>(*frame.acquisition.sequence);
    EXPECT_EQ(frame.counts.front(), static_cast<float>(number));
    EXPECT_EQ(frame.acquisition.device_time, number * 4ms);
    EXPECT_EQ(frame.time, begin + number * 4ms);
    EXPECT_GE(frame.acquisition.arrival_utc, frame.time) << "a frame comes when it is due, or later";
  }
  EXPECT_EQ(device.statistics().frames, 11U);
}

TEST(SimulatedDevice, loses_frames_that_are_not_fetched_within_500_ms) {
  SimulatedDevice device(count, kShape, 1000.0, nullptr);
  const RawFrame first = next_of(device);
  std::this_thread::sleep_for(800ms);
  const RawFrame late = next_of(device);
  const std::uint64_t lost = late.acquisition.lost_before;
  EXPECT_GE(lost, 299U);
  EXPECT_EQ(*late.acquisition.sequence, *first.acquisition.sequence + 1 + lost);
  EXPECT_EQ(device.statistics().lost_frames, lost);
  const Nanos last_lost = late.time - 1ms;
  EXPECT_LE(last_lost, late.acquisition.arrival_utc - 500ms) << "nothing younger is lost";
}

TEST(SimulatedDevice, gives_what_is_due_when_it_is_polled) {
  std::atomic<bool> stop = false;
  SimulatedDevice device(count, kShape, 1e-3, &stop);
  RawFrame frame;
  ASSERT_TRUE(device.readiness());
  EXPECT_EQ(device.readiness()->due, Nanos{}) << "the first frame is there at once";
  EXPECT_EQ(*device.poll(frame), Polled::frame);
  EXPECT_EQ(device.readiness()->due,
            frame.acquisition.device_time.value() +
                (frame.acquisition.arrival_steady - (frame.acquisition.arrival_utc - frame.time)) + 1000s);
  EXPECT_EQ(*device.poll(frame), Polled::nothing) << "the next is due in a quarter of an hour";
  stop = true;
  EXPECT_EQ(*device.poll(frame), Polled::end);
}

TEST(SimulatedDevice, ends_where_the_stop_flag_is_set) {
  std::atomic<bool> stop = false;
  SimulatedDevice device(count, kShape, 1e-3, &stop);
  next_of(device);
  const std::jthread setter([&] { stop = true; });
  RawFrame frame;
  const Result<bool> more = device.next(frame);  // due in a quarter of an hour
  ASSERT_TRUE(more);
  EXPECT_FALSE(*more);
}

}  // namespace
}  // namespace dermis::live::sources
