// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/devices/frame_queue.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "support/allocation_guard.hpp"

namespace dermis::bytes::devices {
namespace {

RawFrame numbered(std::int64_t number) {
  RawFrame frame;
  frame.time = Nanos(number);
  frame.counts.assign(8, static_cast<float>(number));
  return frame;
}

bool push(FrameQueue& queue, std::int64_t number) {
  RawFrame frame = numbered(number);
  return queue.push(frame);
}

/// Number of the next frame, whose counts must agree; -1: none.
std::int64_t pop(FrameQueue& queue) {
  RawFrame frame;
  if (queue.pop(frame, Nanos{}) != FrameQueue::Pop::frame) return -1;
  EXPECT_EQ(frame.counts, numbered(frame.time.count()).counts);
  return frame.time.count();
}

TEST(FrameQueue, gives_frames_in_order) {
  FrameQueue queue(3, Overflow::wait);
  for (std::int64_t round = 0; round < 5; ++round) {
    EXPECT_TRUE(push(queue, 2 * round));
    EXPECT_TRUE(push(queue, 2 * round + 1));
    EXPECT_EQ(queue.statistics().depth, 2U);
    EXPECT_EQ(pop(queue), 2 * round);
    EXPECT_EQ(pop(queue), 2 * round + 1);
  }
  EXPECT_EQ(pop(queue), -1);
  EXPECT_EQ(queue.statistics().most_depth, 2U);
}

TEST(FrameQueue, drops_the_oldest_for_a_viewer) {
  FrameQueue queue(3, Overflow::drop_oldest);
  for (std::int64_t number = 0; number < 10; ++number) EXPECT_TRUE(push(queue, number));
  EXPECT_EQ(queue.statistics().dropped, 7U);
  EXPECT_EQ(pop(queue), 7);
  EXPECT_EQ(pop(queue), 8);
  EXPECT_EQ(pop(queue), 9);
  EXPECT_EQ(pop(queue), -1);
}

TEST(FrameQueue, loses_nothing_for_a_recorder_and_counts_the_waits) {
  constexpr std::int64_t kFrames = 20'000;
  FrameQueue queue(4, Overflow::wait);
  std::thread writer([&] {
    for (std::int64_t number = 0; number < kFrames; ++number) EXPECT_TRUE(push(queue, number));
    queue.close();
  });
  RawFrame frame;
  while (queue.statistics().waits == 0) std::this_thread::yield();  // until the writer has had to wait
  for (std::int64_t number = 0; number < kFrames; ++number) {
    ASSERT_EQ(queue.pop(frame, std::chrono::seconds(60)), FrameQueue::Pop::frame);
    ASSERT_EQ(frame.time.count(), number);
  }
  EXPECT_EQ(queue.pop(frame, std::chrono::seconds(60)), FrameQueue::Pop::end);
  writer.join();
  EXPECT_EQ(queue.statistics().dropped, 0U);
  EXPECT_GT(queue.statistics().longest_wait, Nanos{});
}

TEST(FrameQueue, a_writer_does_not_wait_for_a_reader_that_has_left) {
  FrameQueue queue(1, Overflow::wait);
  EXPECT_TRUE(push(queue, 0));
  std::thread writer([&] { EXPECT_FALSE(push(queue, 1)); });
  queue.leave();
  writer.join();
  EXPECT_FALSE(push(queue, 2));
}

TEST(FrameQueue, a_closed_queue_gives_what_is_left) {
  FrameQueue queue(2, Overflow::wait);
  RawFrame frame;
  EXPECT_TRUE(push(queue, 5));
  queue.close();
  EXPECT_EQ(pop(queue), 5);
  EXPECT_EQ(queue.pop(frame, std::chrono::hours(1)), FrameQueue::Pop::end);
}

TEST(FrameQueue, allocates_nothing_once_its_buffers_have_gone_round) {
  if (!support::kAllocationsAreCounted) GTEST_SKIP() << "the sanitizer owns malloc";
  FrameQueue queue(3, Overflow::drop_oldest);
  RawFrame in = numbered(1);
  RawFrame out;
  const auto pass = [&] {
    in.counts.assign(1000, 1.0F);
    queue.push(in);
    static_cast<void>(queue.pop(out, Nanos{}));
  };
  for (int warm = 0; warm < 10; ++warm) pass();
  const support::AllocationGuard guard;
  for (int round = 0; round < 100; ++round) pass();
  EXPECT_EQ(guard.count(), 0U);
}

}  // namespace
}  // namespace dermis::bytes::devices
