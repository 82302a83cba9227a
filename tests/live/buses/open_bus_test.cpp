// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/buses/open_bus.hpp"

#include <gtest/gtest.h>
#include <poll.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "dermis/live/dds/publisher.hpp"
#include "live/buses/array_feed.hpp"
#include "live/buses/register_device.hpp"

namespace dermis::live::buses {
namespace {

using std::chrono::milliseconds;
using Opened = Result<std::unique_ptr<FrameSource>>;

/// Two arrays of a RegisterDevice that follow upon each other, and one that it refuses.
class OpenBus : public ::testing::Test {
 protected:
  void SetUp() override {
    map_ = ::testing::TempDir() + "registers_" + std::to_string(::getpid()) + ".toml";
    std::ofstream(map_) << "[registers]\narray = [{name = \"left\", address = 3000, rows = 2, cols = 3},\n"
                           "{name = \"right\", address = 3006, rows = 1, cols = 2},\n"
                           "{name = \"other\", address = 5, rows = 1, cols = 2},\n"
                           "{name = \"large\", address = 4000, rows = 16, cols = 16}]\n";
    const Opened tried = open("left");
    if (!tried && tried.error().message.find("libdermis_modbus.so") != std::string::npos) {
      GTEST_SKIP() << tried.error().message;
    }
  }
  void TearDown() override { ::unlink(map_.c_str()); }

  [[nodiscard]] std::string address(const std::string& array, const std::string& more = "") const {
    return "modbus-tcp://127.0.0.1:" + std::to_string(device_.port()) + "?map=" + map_ + more + "&array=" + array;
  }
  [[nodiscard]] Opened open(const std::string& array, const BusOptions& options = {},
                            const std::string& more = "") const {
    return open_bus(*parse_bus_address(address(array, more)), options);
  }

  RegisterDevice device_;
  std::string map_;
};

TEST_F(OpenBus, arrays_share_a_connection_and_get_every_answer) {
  const Opened left = open("left");
  ASSERT_TRUE(left) << left.error().message;
  const Opened right = open("right");
  ASSERT_TRUE(right) << "the device takes one client at a time";
  RawFrame first;
  RawFrame frame;
  ASSERT_TRUE(*(*left)->next(first));
  for (int k = 1; k < 100; ++k) {
    ASSERT_TRUE(*(*left)->next(frame));
    ASSERT_EQ(frame.counts.size(), 6U);
    EXPECT_EQ(frame.counts[0], first.counts[0] + static_cast<float>(k)) << "an answer is missing";
    EXPECT_EQ(frame.counts[5], frame.counts[0] + 5.0F);
    EXPECT_GT(frame.time, first.time);
  }
  ASSERT_TRUE(*(*right)->next(frame));
  EXPECT_EQ(frame.counts[1], frame.counts[0] + 1.0F);
  EXPECT_EQ((*right)->shape(), (FrameShape{1, 2}));
  EXPECT_GE((*left)->statistics().frames, 100U);
}

TEST_F(OpenBus, a_frame_is_made_of_the_answers_to_its_own_questions) {
  const RegisterDevice liar(7);
  const std::string place = "modbus-tcp://127.0.0.1:" + std::to_string(liar.port()) + "?map=" + map_ + "&array=large";
  const Opened large = open_bus(*parse_bus_address(place), {});
  ASSERT_TRUE(large) << large.error().message;
  RawFrame frame;
  for (int k = 0; k < 100; ++k) {
    ASSERT_TRUE(*(*large)->next(frame));
    EXPECT_EQ(frame.counts[125] - frame.counts[0], 126.0F) << "frame " << k << " has words of another round";
    EXPECT_EQ(frame.counts[255] - frame.counts[0], 257.0F) << "frame " << k << " has words of another round";
  }
  EXPECT_GT((*large)->statistics().damaged_frames, 20U);
}

TEST_F(OpenBus, a_caller_of_several_sources_may_wait_for_a_descriptor) {
  const Opened left = open("left", {}, "&rate=50");
  ASSERT_TRUE(left);
  RawFrame frame;
  int frames = 0;
  while (frames < 20) {
    pollfd event{(*left)->readiness()->descriptor, POLLIN, 0};
    ASSERT_EQ(::poll(&event, 1, 60'000), 1);
    while (*(*left)->poll(frame) == Polled::frame) ++frames;
  }
}

TEST_F(OpenBus, a_device_that_hangs_up_is_connected_again) {
  std::mutex mutex;
  std::vector<std::string> notices;
  BusOptions options;
  options.notice = [&](const std::string& text) {
    const std::lock_guard lock(mutex);
    notices.push_back(text);
  };
  const Opened left = open("left", options);
  ASSERT_TRUE(left);
  RawFrame frame;
  ASSERT_TRUE(*(*left)->next(frame));
  device_.hang_up();
  while ((*left)->statistics().reconnections == 0) ASSERT_TRUE(*(*left)->next(frame));
  ASSERT_TRUE(*(*left)->next(frame));
  const std::lock_guard lock(mutex);
  ASSERT_EQ(notices.size(), 2U);
  EXPECT_NE(notices[0].find("waiting up to 10 s for it to come back"), std::string::npos) << notices[0];
  EXPECT_NE(notices[1].find(" is back"), std::string::npos) << notices[1];
}

TEST_F(OpenBus, registers_that_the_device_does_not_have_end_the_source) {
  const Opened other = open("other");
  ASSERT_TRUE(other);
  RawFrame frame;
  const Result<bool> next = (*other)->next(frame);
  ASSERT_FALSE(next);
  EXPECT_NE(next.error().message.find("does not give 2 registers from 5 on: Illegal data address"), std::string::npos)
      << next.error().message;
}

TEST_F(OpenBus, a_stop_ends_it) {
  std::atomic<bool> stop = false;
  const Opened left = open("left", {.stop = &stop}, "&rate=0.01");
  ASSERT_TRUE(left);
  RawFrame frame;
  ASSERT_TRUE(*(*left)->next(frame));
  stop = true;
  EXPECT_FALSE(*(*left)->next(frame));
}

TEST_F(OpenBus, errors_name_the_arrays_and_the_shapes) {
  const auto error = [](const Opened& opened) { return opened.error().message; };
  EXPECT_NE(error(open("lfet")).find("has no array 'lfet'; did you mean 'left'?"), std::string::npos);
  EXPECT_NE(error(open("left", {.shape = FrameShape{3, 3}})).find("frames are 2x3, the array is 3x3"),
            std::string::npos);
  const std::string text = address("left");
  const Opened unnamed = open_bus(*parse_bus_address(text.substr(0, text.rfind('&'))), {});
  EXPECT_NE(error(unnamed).find("has several arrays; add array=NAME, of left, right, other, large"), std::string::npos);
}

TEST(OpenBusFails, where_nobody_answers_or_nothing_is_known) {
  const auto error = [](const std::string& text) { return open_bus(*parse_bus_address(text), {}).error().message; };
  EXPECT_NE(error("modbus-tcp://127.0.0.1:1?map=x").find("map=x: is not known"), std::string::npos);
  EXPECT_NE(error("dds://0/t?type=x").find("type=x: is not known"), std::string::npos);
  const std::string away = error("modbus-tcp://127.0.0.1:1?map=inspire-rh56&array=palm");
  if (away.find("libdermis_modbus.so") != std::string::npos) GTEST_SKIP() << away;
  EXPECT_NE(away.find("127.0.0.1:1 does not answer: Connection refused; check the address"), std::string::npos) << away;
}

TEST(OpenBusOfTopics, frames_of_another_dermis_alone_are_turned_already) {
  const auto is_turned = [](const std::string& text) { return sends_turned_frames(*parse_bus_address(text)); };
  EXPECT_TRUE(is_turned("dds://0/rt/chest/frame?type=dermis_msgs/RawFrame"));
  EXPECT_FALSE(is_turned("dds://0/rt/chest/raw?type=sensor_msgs/Image"));
  EXPECT_FALSE(is_turned("dds://0/rt/chest/raw?type=unknown"));
  EXPECT_FALSE(is_turned("modbus-tcp://127.0.0.1?map=inspire-rh56"));
}

TEST(OpenBusOfTopics, frames_count_the_messages_of_the_topic) {
  const auto domain = static_cast<std::uint32_t>(100 + ::getpid() % 100);
  const std::string place = "dds://" + std::to_string(domain) + "/rt/chest/raw?type=sensor_msgs/msg/Image&loopback=1";
  const Opened source = open_bus(*parse_bus_address(place), {});
  if (!source) GTEST_SKIP() << source.error().message;
  const auto publisher = dds::Publisher::create({.domain = domain, .loopback_only = true});
  ASSERT_TRUE(publisher);
  const Result<dds::TopicId> topic =
      (*publisher)->add_topic({.name = "/chest/raw", .type = bytes::ros_messages::image_type()});
  ASSERT_TRUE(topic);
  while (!(*publisher)->has_subscribers(*topic)) std::this_thread::sleep_for(milliseconds(10));
  std::vector<std::uint8_t> message;
  RawFrame sent;
  for (int k = 0; k < 50; ++k) {
    sent.time = milliseconds(k);
    sent.counts.assign(6, static_cast<float>(k));
    bytes::ros_messages::encode_image(sent, {2, 3}, "chest", message);
    (*publisher)->publish(*topic, message);
  }
  RawFrame frame;
  std::uint64_t first = 0;
  for (std::uint64_t k = 0; k < 50; ++k) {
    ASSERT_TRUE(*(*source)->next(frame));
    if (k == 0) first = *frame.acquisition.sequence;
    EXPECT_EQ(frame.counts, std::vector<float>(6, static_cast<float>(k)));
    EXPECT_EQ(frame.acquisition.sequence, first + k);
    EXPECT_EQ(frame.acquisition.device_time, Nanos(milliseconds(k)));
  }
  EXPECT_EQ((*source)->shape(), (FrameShape{2, 3}));
}

TEST(ArrayFeed, a_reader_that_falls_behind_hears_how_many_frames_it_lost) {
  ArrayFeed feed({});
  RawFrame frame;
  frame.counts = {1.0F};
  for (int k = 0; k < 5000; ++k) feed.push({1, 1}, frame);
  EXPECT_EQ(feed.statistics().lost_frames, 904U);
  ASSERT_EQ(*feed.take(frame), Polled::frame);
  EXPECT_EQ(frame.acquisition.lost_before, 904U);
  int more = 0;
  while (*feed.take(frame) == Polled::frame) ++more;
  EXPECT_EQ(more, 4095);
  feed.end(bad_input("gone"));
  EXPECT_EQ(feed.take(frame).error().message, "gone");
}

/// Notices, and a feed that tells them.
class NotedFeed : public ::testing::Test {
 protected:
  [[nodiscard]] ArrayFeed feed(std::optional<FrameShape> shape = {}) {
    return ArrayFeed([this](const std::string& text) { notices_.push_back(text); }, "'mat'", shape);
  }
  static RawFrame frame_of(const FrameShape& shape) {
    RawFrame frame;
    frame.counts.assign(shape.taxel_count(), 1.0F);
    return frame;
  }

  std::vector<std::string> notices_;
};

TEST_F(NotedFeed, frames_of_another_shape_than_the_first_are_damaged) {
  ArrayFeed feed = this->feed();
  feed.push({2, 3}, frame_of({2, 3}));
  for (const FrameShape shape : {FrameShape{64, 64}, {3, 2}, {2, 3}}) feed.push(shape, frame_of(shape));
  EXPECT_EQ(feed.shape(), (FrameShape{2, 3}));
  RawFrame frame;
  for (int k = 0; k < 2; ++k) {
    ASSERT_EQ(*feed.take(frame), Polled::frame);
    EXPECT_EQ(frame.counts.size(), 6U);
  }
  EXPECT_EQ(*feed.take(frame), Polled::nothing);
  EXPECT_EQ(feed.statistics().damaged_frames, 2U);
  EXPECT_EQ(notices_, std::vector<std::string>{"'mat': frames that are 64x64 are left out, as the array is 2x3"});
}

TEST_F(NotedFeed, a_first_frame_of_another_shape_than_the_array_ends_it) {
  ArrayFeed feed = this->feed(FrameShape{2, 3});
  feed.push({3, 2}, frame_of({3, 2}));
  feed.push({2, 3}, frame_of({2, 3}));
  RawFrame frame;
  EXPECT_EQ(feed.take(frame).error().message, "frames are 3x2, the array is 2x3");
}

TEST_F(NotedFeed, a_later_frame_of_another_shape_than_the_array_is_damaged) {
  ArrayFeed feed = this->feed(FrameShape{2, 3});
  feed.push({2, 3}, frame_of({2, 3}));
  feed.push({3, 2}, frame_of({3, 2}));
  RawFrame frame;
  ASSERT_EQ(*feed.take(frame), Polled::frame);
  EXPECT_EQ(*feed.take(frame), Polled::nothing);
  EXPECT_EQ(feed.statistics().damaged_frames, 1U);
}

}  // namespace
}  // namespace dermis::live::buses
