// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "live/buses/can_bus.hpp"

#include <gtest/gtest.h>
#include <linux/can.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstring>

#include "dermis/live/buses/open_bus.hpp"

namespace dermis::live::buses {
namespace {

using namespace std::chrono_literals;

/// The other end of the socket, which stands for a bus: packets of the kernel's can_frame.
class Hand {
 public:
  Hand() { EXPECT_EQ(::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends_.data()), 0); }
  ~Hand() { ::close(ends_[0]); }

  [[nodiscard]] int socket() const { return ends_[1]; }
  void send(std::uint32_t id, const std::vector<std::uint8_t>& data) const {
    can_frame frame{};
    frame.can_id = id;
    frame.can_dlc = static_cast<std::uint8_t>(data.size());
    std::copy(data.begin(), data.end(), frame.data);
    EXPECT_EQ(::send(ends_[0], &frame, sizeof(frame), 0), static_cast<ssize_t>(sizeof(frame)));
  }
  /// The question that comes next.
  [[nodiscard]] can_frame question() const {
    can_frame frame{};
    EXPECT_EQ(::recv(ends_[0], &frame, sizeof(frame), 0), static_cast<ssize_t>(sizeof(frame)));
    return frame;
  }

 private:
  std::array<int, 2> ends_{};
};

RawFrame next_of(ArrayFeed& feed) {
  RawFrame frame;
  feed.wait(10s);
  EXPECT_EQ(*feed.take(frame), Polled::frame);
  return frame;
}

TEST(CanBus, arrays_that_must_be_asked_are_asked_in_turn_where_somebody_reads_them) {
  const Hand hand;
  CanBus bus({.interface = "can0"}, *read_can_map("linkerhand-10x4-left"), hand.socket());
  const auto index = std::make_shared<ArrayFeed>(nullptr);
  const auto little = std::make_shared<ArrayFeed>(nullptr);
  bus.add(1, index);
  EXPECT_EQ(hand.question().data[0], 0xB2);
  bus.add(4, little);
  can_frame question = hand.question();
  while (question.data[0] == 0xB2) question = hand.question();
  EXPECT_EQ(question.can_id, 0x28U);
  EXPECT_EQ(question.can_dlc, 2);
  EXPECT_EQ(question.data[0], 0xB5);
  EXPECT_EQ(question.data[1], 0xA4);
  for (std::uint8_t row = 0; row < 10; ++row)
    hand.send(0x28, {0xB5, static_cast<std::uint8_t>(row << 4U), row, 1, 2, 3});
  const RawFrame frame = next_of(*little);
  EXPECT_EQ(frame.counts[36], 9.0F);
  EXPECT_EQ(frame.counts[37], 1.0F);
  EXPECT_GT(frame.time, Nanos{});
}

TEST(CanBus, remote_frames_and_errors_are_passed_over) {
  const Hand hand;
  const CanMap map{{{.name = "a", .shape = {1, 2}, .id = 5}}};
  CanBus bus({.interface = "can0"}, map, hand.socket());
  const auto feed = std::make_shared<ArrayFeed>(nullptr);
  bus.add(0, feed);
  hand.send(5 | CAN_RTR_FLAG, {9, 9});
  hand.send(5 | CAN_ERR_FLAG, {8, 8});
  hand.send(5, {1, 2});
  EXPECT_EQ(next_of(*feed).counts, (std::vector<float>{1, 2}));
}

TEST(CanBus, an_interface_that_goes_is_waited_for_and_then_told) {
  auto hand = std::make_unique<Hand>();
  const CanMap map{{{.name = "a", .shape = {1, 2}, .id = 5}}};
  CanBus bus({.interface = "no_such_can", .reconnect = Nanos{}}, map, hand->socket());
  const auto feed = std::make_shared<ArrayFeed>(nullptr);
  bus.add(0, feed);
  hand.reset();
  RawFrame frame;
  feed->wait(10s);
  const Result<Polled> polled = feed->take(frame);
  ASSERT_FALSE(polled);
  EXPECT_EQ(polled.error().message, "no_such_can has not come back within 0 s");
}

TEST(CanBus, an_interface_that_is_not_there_is_told_with_the_mend) {
  const auto source = open_bus(*parse_bus_address("can://no_such_can?map=linkerhand-12x6-left&array=thumb"), {});
  ASSERT_FALSE(source);
  const bool has_can = source.error().message.find("this kernel has no CAN") == std::string::npos;
  if (has_can) {
    EXPECT_NE(source.error().message.find("ip link set no_such_can up"), std::string::npos);
  }
}

}  // namespace
}  // namespace dermis::live::buses
