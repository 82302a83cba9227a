// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "live/dds/writing_queue.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <future>
#include <optional>
#include <vector>

#include "support/allocation_guard.hpp"

namespace dermis::live::dds {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// Keeps what it is to write; its first message takes until the test lets it go on.
class StalledWriter final : public Writer {
 public:
  [[nodiscard]] bool has_readers() const noexcept override { return true; }
  void write(std::span<const std::uint8_t> message) override {
    if (written_.empty()) {
      begun_.set_value();
      go_on_.get_future().wait();
    }
    written_.emplace_back(message.begin(), message.end());
  }

  void await_the_first() { begun_.get_future().wait(); }
  void go_on() { go_on_.set_value(); }
  [[nodiscard]] const std::vector<Bytes>& written() const { return written_; }

 private:
  std::promise<void> begun_;
  std::promise<void> go_on_;
  std::vector<Bytes> written_;
};

TEST(WritingQueue, who_has_a_message_does_not_wait_for_the_network_and_is_told_what_has_no_room) {
  StalledWriter writer;
  std::optional<WritingQueue> queue(100);
  ASSERT_TRUE(queue->push(writer, Bytes(40, 1)));
  writer.await_the_first();
  EXPECT_TRUE(queue->push(writer, Bytes(60, 2)));
  EXPECT_FALSE(queue->push(writer, Bytes(1, 3))) << "the first is not written yet";
  EXPECT_FALSE(queue->push(writer, Bytes(1000, 3)));
  writer.go_on();
  queue.reset();
  EXPECT_EQ(writer.written(), (std::vector<Bytes>{Bytes(40, 1), Bytes(60, 2)}));
}

TEST(WritingQueue, all_that_waits_is_written_in_its_order_before_the_end) {
  StalledWriter first;
  StalledWriter second;
  second.go_on();
  std::optional<WritingQueue> queue(1000);
  ASSERT_TRUE(queue->push(first, Bytes{0}));
  first.await_the_first();
  for (std::uint8_t k = 1; k < 100; ++k) ASSERT_TRUE(queue->push(k % 2 == 0 ? first : second, Bytes{k}));
  first.go_on();
  queue.reset();
  ASSERT_EQ(first.written().size(), 50U);
  ASSERT_EQ(second.written().size(), 50U);
  for (std::size_t k = 0; k < 50; ++k) {
    EXPECT_EQ(first.written()[k][0], 2 * k);
    EXPECT_EQ(second.written()[k][0], 2 * k + 1);
  }
}

TEST(WritingQueue, nothing_is_allocated_once_as_many_messages_have_waited) {
  if (!support::kAllocationsAreCounted) GTEST_SKIP() << "a sanitizer owns malloc";
  const Bytes message(500, 7);
  StalledWriter first;
  StalledWriter last;
  StalledWriter again;
  std::optional<WritingQueue> queue(1'000'000);
  ASSERT_TRUE(queue->push(first, message));
  first.await_the_first();
  for (int k = 0; k < 20; ++k) ASSERT_TRUE(queue->push(first, message));
  ASSERT_TRUE(queue->push(last, message));
  first.go_on();
  last.await_the_first();
  ASSERT_TRUE(queue->push(again, message));
  last.go_on();
  again.await_the_first();
  const support::AllocationGuard guard;
  for (int k = 0; k < 20; ++k) ASSERT_TRUE(queue->push(first, message));
  EXPECT_EQ(guard.count(), 0U);
  again.go_on();
  queue.reset();
}

}  // namespace
}  // namespace dermis::live::dds
