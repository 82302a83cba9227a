// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/recordings/joint_states.hpp"

#include <gtest/gtest.h>

#include "dermis/bytes/recordings/mcap.hpp"
#include "support/joint_messages.hpp"
#include "support/temporary_folder.hpp"

namespace dermis::bytes::recordings {
namespace {

class JointStates : public testing::Test {
 protected:
  void SetUp() override {
    const auto writer = McapWriter::create(path_, McapCompression::lz4);
    ASSERT_TRUE(writer) << writer.error().message;
    add("/right", ros_messages::kJointState, **writer);
    add("/left", ros_messages::kJointState, **writer);
    add("/camera", "sensor_msgs/msg/Image", **writer);
    ASSERT_TRUE((*writer)->finish());
  }

  static void add(const std::string& topic, const std::string& type, McapWriter& writer) {
    const std::uint16_t channel = writer.add_channel({topic, "cdr", type, "ros2msg", "float64[] position"});
    for (std::uint64_t k = 1; k <= 3; ++k) {
      const std::vector<std::uint8_t> message = support::joint_message({{topic, static_cast<double>(k)}});
      writer.add_message({channel, static_cast<std::uint32_t>(k), 10 * k, 10 * k, message});
    }
  }

  support::TemporaryFolder folder_;
  std::string path_ = folder_.file("robot.mcap");
};

TEST_F(JointStates, have_topics_in_order_and_messages_with_log_times) {
  EXPECT_EQ(joint_topics(path_).value(), (std::vector<std::string>{"/left", "/right"}));
  std::vector<std::int64_t> times;
  std::vector<double> numbers;
  const Status read = read_joint_states(path_, "/left", [&](Nanos time, const ros_messages::JointNumbers& joints) {
    EXPECT_EQ(joints.names, (std::vector<std::string>{"/left"}));
    times.push_back(time.count());
    numbers.push_back(joints.numbers.front());
  });
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(times, (std::vector<std::int64_t>{10, 20, 30}));
  EXPECT_EQ(numbers, (std::vector<double>{1, 2, 3}));
}

TEST_F(JointStates, fail_where_there_is_no_recording_or_a_message_is_damaged) {
  EXPECT_FALSE(joint_topics(folder_.file("none.mcap")));
  const std::string damaged = folder_.file("damaged.mcap");
  const auto writer = McapWriter::create(damaged, McapCompression::none);
  ASSERT_TRUE(writer);
  const std::uint16_t channel = (*writer)->add_channel({"/arm", "cdr", ros_messages::kJointState, "ros2msg", ""});
  const std::vector<std::uint8_t> message = {0, 1, 0, 0};
  (*writer)->add_message({channel, 7, 10, 10, message});
  ASSERT_TRUE((*writer)->finish());
  EXPECT_EQ(read_joint_states(damaged, "/arm", [](Nanos, const ros_messages::JointNumbers&) {}).error().message,
            damaged + ": message 7 of /arm: the message is no whole sensor_msgs/msg/JointState in CDR");
}

}  // namespace
}  // namespace dermis::bytes::recordings
