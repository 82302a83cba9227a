// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "live/buses/topic_bus.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <limits>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "dermis/bytes/ros_messages/ros_messages.hpp"

namespace dermis::live::buses {
namespace {

constexpr FrameShape kShape{2, 3};

RawFrame sent_frame() {
  RawFrame frame;
  frame.time = Nanos(1'700'000'000'123'456'789);
  frame.temperature_celsius = 31.5;
  frame.supply_v = 5.02;
  frame.counts = {1, 2, 3, 4, 5, 6.5F};
  frame.acquisition = {1000, Nanos(-7), Nanos(11), Nanos(13), 2, 1};
  return frame;
}

/// A topic that is told its messages here, and the reader of its only array.
class Topic {
 public:
  explicit Topic(const std::string& type) : bus_(**bytes::ros_messages::find_touch_type(type), "rt/chest") {
    bus_.add(0, feed_);
  }

  RawFrame hear(std::uint64_t sequence, std::uint8_t writer = 1, Nanos source_time = Nanos(17)) {
    RawFrame frame;
    bus_.hear({message, sequence, source_time, {writer}});
    EXPECT_EQ(*feed_->take(frame), Polled::frame);
    return frame;
  }
  /// A frame of another dermis is one for the reader.
  bool takes(const RawFrame& sent, std::uint8_t writer = 1) {
    bytes::ros_messages::encode_raw_frame(sent, kShape, "chest", message);
    bus_.hear({message, ++sequence_, Nanos(17), {writer}});
    RawFrame frame;
    return *feed_->take(frame) == Polled::frame;
  }
  [[nodiscard]] std::uint64_t damaged() const { return feed_->statistics().damaged_frames; }

  std::vector<std::uint8_t> message;
  std::vector<std::string> notices;

 private:
  std::uint64_t sequence_ = 0;
  std::shared_ptr<ArrayFeed> feed_ =
      std::make_shared<ArrayFeed>([this](const std::string& text) { notices.push_back(text); });
  TopicBus bus_;
};

TEST(TopicBus, frames_of_another_dermis_stay_as_they_were_sent_but_for_the_steady_clock) {
  Topic topic("dermis_msgs/RawFrame");
  const RawFrame sent = sent_frame();
  bytes::ros_messages::encode_raw_frame(sent, kShape, "chest", topic.message);
  RawFrame frame = topic.hear(1);
  EXPECT_EQ(frame.counts, sent.counts);
  EXPECT_EQ(frame.time, sent.time);
  EXPECT_EQ(frame.temperature_celsius, sent.temperature_celsius);
  EXPECT_EQ(frame.supply_v, sent.supply_v);
  EXPECT_GT(frame.acquisition.arrival_steady, Nanos(11));
  frame.acquisition.arrival_steady = Nanos(11);
  EXPECT_EQ(frame.acquisition, sent.acquisition);
}

TEST(TopicBus, messages_that_the_network_lost_are_counted_with_those_that_the_device_lost) {
  Topic topic("dermis_msgs/RawFrame");
  bytes::ros_messages::encode_raw_frame(sent_frame(), kShape, "chest", topic.message);
  EXPECT_EQ(topic.hear(5).acquisition.lost_before, 2U);
  EXPECT_EQ(topic.hear(9).acquisition.lost_before, 3U + 2U);
  EXPECT_EQ(topic.hear(10).acquisition.lost_before, 2U);
}

TEST(TopicBus, lost_messages_are_counted_by_the_numbers_of_their_writer) {
  Topic topic("sensor_msgs/Image");
  bytes::ros_messages::encode_image(sent_frame(), kShape, "chest", topic.message);
  EXPECT_EQ(topic.hear(5).acquisition.lost_before, 0U);
  EXPECT_EQ(topic.hear(1, 2).acquisition.lost_before, 0U);
  EXPECT_EQ(topic.hear(7).acquisition.lost_before, 1U);
}

TEST(TopicBus, more_lost_messages_than_can_be_counted_are_as_many_as_can_be) {
  Topic topic("dermis_msgs/RawFrame");
  RawFrame sent = sent_frame();
  sent.acquisition.lost_before = std::numeric_limits<std::uint32_t>::max();
  bytes::ros_messages::encode_raw_frame(sent, kShape, "chest", topic.message);
  topic.hear(1);
  EXPECT_EQ(topic.hear(3).acquisition.lost_before, std::numeric_limits<std::uint32_t>::max());
}

TEST(TopicBus, frames_of_a_second_dermis_are_damaged) {
  Topic topic("dermis_msgs/RawFrame");
  EXPECT_TRUE(topic.takes(sent_frame(), 1));
  for (int k = 0; k < 3; ++k) EXPECT_FALSE(topic.takes(sent_frame(), 2));
  EXPECT_TRUE(topic.takes(sent_frame(), 1));
  EXPECT_EQ(topic.damaged(), 3U);
  ASSERT_EQ(topic.notices.size(), 1U);
  EXPECT_TRUE(
      topic.notices[0].starts_with("'rt/chest' of type dermis_msgs::msg::dds_::RawFrame_: frames of another "
                                   "sender are left out"))
      << topic.notices[0];
}

TEST(TopicBus, frames_of_another_dermis_whose_time_cannot_be_are_damaged) {
  Topic topic("dermis_msgs/RawFrame");
  RawFrame sent = sent_frame();
  const Nanos begin = sent.time;
  EXPECT_TRUE(topic.takes(sent));
  for (const Nanos wrong : {begin - Nanos(1), Nanos::max(), Nanos::min(), begin + std::chrono::hours(1)}) {
    sent.time = wrong;
    EXPECT_FALSE(topic.takes(sent)) << wrong.count();
  }
  sent.time = begin + Nanos(1);
  EXPECT_TRUE(topic.takes(sent));
  EXPECT_EQ(topic.damaged(), 4U);
  EXPECT_EQ(topic.notices.size(), 1U);
}

TEST(TopicBus, messages_of_others_are_counted_and_stamped_here) {
  Topic topic("sensor_msgs/Image");
  bytes::ros_messages::encode_image(sent_frame(), kShape, "chest", topic.message);
  const RawFrame first = topic.hear(5);
  const RawFrame second = topic.hear(9);
  EXPECT_EQ(first.acquisition.device_time, sent_frame().time);
  EXPECT_EQ(second.acquisition.lost_before, 3U);
  EXPECT_EQ(*second.acquisition.sequence, *first.acquisition.sequence + 4);
}

TEST(TopicBus, a_message_that_was_late_on_its_way_is_not_late_in_time) {
  Topic topic("std_msgs/Float32MultiArray");
  topic.message = {0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0x80, 0x3F};
  const Nanos began = std::chrono::steady_clock::now().time_since_epoch();
  const RawFrame first = topic.hear(1, 1, Nanos(0));
  std::this_thread::sleep_for(std::chrono::milliseconds(30));
  const RawFrame second = topic.hear(2, 1, std::chrono::milliseconds(10));
  const Nanos late = second.acquisition.arrival_steady - began;
  EXPECT_GE(late, std::chrono::milliseconds(30));
  EXPECT_GT(second.time, first.time);
  EXPECT_LE(second.time - first.time, std::chrono::milliseconds(11)) << "10 ms, and 2 % of a drift";
  EXPECT_EQ(second.acquisition.device_time, Nanos(std::chrono::milliseconds(10)));
}

TEST(TopicBus, another_writer_has_another_clock) {
  Topic topic("std_msgs/Float32MultiArray");
  topic.message = {0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0x80, 0x3F};
  const RawFrame first = topic.hear(1, 1, Nanos(0));
  std::this_thread::sleep_for(std::chrono::milliseconds(30));
  const RawFrame second = topic.hear(1, 2, Nanos(1));
  EXPECT_GE(second.time - first.time, std::chrono::milliseconds(30));
}

}  // namespace
}  // namespace dermis::live::buses
