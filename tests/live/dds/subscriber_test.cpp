// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/dds/subscriber.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

namespace dermis::live::dds {
namespace {

// tests/live/buses/hands_test.py shows what writers of another vendor send.

const PublisherOptions kHere{.domain = static_cast<std::uint32_t>(100 + ::getpid() % 100), .loopback_only = true};

TEST(Subscriber, a_domain_has_ports_of_its_own) {
  EXPECT_EQ(Subscriber::create({.domain = 233}, {}).error().message, "domain: must be 0 to 232, is 233");
}

TEST(Subscriber, every_message_of_a_publisher_is_heard_once_and_in_order) {
  std::mutex mutex;
  std::condition_variable heard;
  std::vector<std::vector<std::uint8_t>> messages;
  std::vector<std::uint64_t> sequences;
  const auto hear = [&](const Sample& sample) {
    const std::lock_guard lock(mutex);
    messages.emplace_back(sample.message.begin(), sample.message.end());
    sequences.push_back(sample.sequence);
    heard.notify_all();
  };
  const auto subscriber = Subscriber::create(kHere, {"rt/here/raw", "sensor_msgs::msg::dds_::Image_", hear});
  if (!subscriber) GTEST_SKIP() << subscriber.error().message;
  const auto publisher = Publisher::create(kHere);
  ASSERT_TRUE(publisher);
  const Result<TopicId> topic =
      (*publisher)->add_topic({.name = "/here/raw", .type = bytes::ros_messages::image_type()});
  ASSERT_TRUE(topic);
  while (!(*publisher)->has_subscribers(*topic)) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  std::vector<std::uint8_t> message{0, 1, 0, 0, 0};
  for (std::uint8_t k = 0; k < 100; ++k) {
    message.back() = k;
    (*publisher)->publish(*topic, message);
  }
  std::unique_lock lock(mutex);
  ASSERT_TRUE(heard.wait_for(lock, std::chrono::seconds(60), [&] { return messages.size() == 100; }));
  for (std::uint8_t k = 0; k < 100; ++k) {
    EXPECT_EQ(messages[k][4], k);
    EXPECT_EQ(sequences[k], sequences[0] + k);
  }
}

}  // namespace
}  // namespace dermis::live::dds
