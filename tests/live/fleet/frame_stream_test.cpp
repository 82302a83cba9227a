// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/fleet/frame_stream.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <string>
#include <thread>

#include "dermis/live/fleet/frame_publisher.hpp"
#include "nats_server.hpp"

namespace dermis::live::fleet {
namespace {

using std::chrono::milliseconds;

const bytes::recordings::RecordedArray kArray{
    .name = "chest", .shape = {2, 3}, .array_toml = "[array]\nname = \"chest\"\n", .model_hash = "fnv1a64:1"};

RawFrame frame_number(std::uint64_t number) {
  RawFrame frame;
  frame.time = Nanos(milliseconds(1'760'000'000'000 + 10 * static_cast<std::int64_t>(number)));
  frame.acquisition.sequence = number;
  frame.counts.assign(6, static_cast<float>(number % 1000));
  return frame;
}

class Streaming : public testing::Test {
 public:
  void SetUp() override {
    if (!support::NatsServer::is_installed()) GTEST_SKIP() << "skipped: nats-server is not installed";
    server = std::make_unique<support::NatsServer>();
    auto made = FramePublisher::create({kArray}, {.broker = {server->url()}, .robot = "r1"});
    if (!made) GTEST_SKIP() << "skipped: " << made.error().message;
    publisher = *std::move(made);
  }

  void publish(std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) publisher->publish(0, frame_number(next++));
    while (publisher->counts().frames < next) std::this_thread::sleep_for(milliseconds(20));
  }

  [[nodiscard]] Result<std::unique_ptr<FrameStream>> open(const std::string& rest,
                                                          FrameStreamOptions options = {}) const {
    const auto address = parse_stream_address(server->url() + "?robot=r1&array=chest" + rest);
    EXPECT_TRUE(address) << address.error().message;
    return FrameStream::open(*address, std::move(options));
  }

  std::unique_ptr<support::NatsServer> server;
  std::unique_ptr<FramePublisher> publisher;
  std::uint64_t next = 0;
};

TEST_F(Streaming, tells_what_the_robot_says_of_the_array) {
  publish(30);
  const auto stream = open("&from=1&to=last");
  ASSERT_TRUE(stream) << stream.error().message;
  EXPECT_EQ((*stream)->shape(), kArray.shape);
  EXPECT_EQ((*stream)->notes(), (bytes::recordings::FrameNotes{"chest", kArray.array_toml, "fnv1a64:1", ""}));
  EXPECT_FALSE((*stream)->is_live());
}

TEST_F(Streaming, new_frames_come_as_they_are_published) {
  publish(30);
  const auto stream = open("");
  ASSERT_TRUE(stream) << stream.error().message;
  EXPECT_TRUE((*stream)->is_live());
  publish(30);
  RawFrame frame;
  for (std::uint64_t number = 30; number < 60; ++number) {
    ASSERT_TRUE(*(*stream)->next(frame));
    EXPECT_EQ(frame.acquisition.sequence, number);
  }
}

TEST_F(Streaming, begins_at_a_time) {
  publish(50);
  std::this_thread::sleep_for(milliseconds(1100));
  const auto now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  publish(50);
  char text[32];
  std::strftime(text, sizeof(text), "%Y-%m-%dT%H:%M:%SZ", std::gmtime(&now));
  const auto stream = open(std::string("&from=") + text + "&to=last");
  ASSERT_TRUE(stream) << stream.error().message;
  RawFrame frame;
  for (std::uint64_t number = 50; number < 100; ++number) {
    ASSERT_TRUE(*(*stream)->next(frame));
    EXPECT_EQ(frame.acquisition.sequence, number);
  }
  EXPECT_FALSE(*(*stream)->next(frame));
}

TEST_F(Streaming, goes_on_where_it_was_when_the_server_comes_back) {
  publish(30);
  const auto stream = open("&from=1");
  ASSERT_TRUE(stream) << stream.error().message;
  RawFrame frame;
  for (std::uint64_t number = 0; number < 30; ++number) ASSERT_TRUE(*(*stream)->next(frame));
  server->kill();
  std::jthread restart([&] {
    std::this_thread::sleep_for(milliseconds(500));
    server->start();
    publish(30);
  });
  for (std::uint64_t number = 30; number < 60; ++number) {
    ASSERT_TRUE(*(*stream)->next(frame));
    EXPECT_EQ(frame.acquisition.sequence, number);
  }
}

TEST_F(Streaming, ends_when_it_is_stopped) {
  publish(1);
  std::atomic<bool> stop = false;
  const auto stream = open("", {.stop = &stop});
  ASSERT_TRUE(stream) << stream.error().message;
  std::jthread stopper([&] {
    std::this_thread::sleep_for(milliseconds(100));
    stop = true;
  });
  RawFrame frame;
  EXPECT_FALSE(*(*stream)->next(frame));
}

TEST_F(Streaming, an_array_of_which_nothing_came_is_an_error) {
  publish(1);
  const auto address = parse_stream_address(server->url() + "?robot=r1&array=back");
  const auto stream = FrameStream::open(*address);
  ASSERT_FALSE(stream);
  EXPECT_NE(stream.error().message.find("the server has no frames of array 'back' of robot 'r1'"), std::string::npos)
      << stream.error().message;
}

}  // namespace
}  // namespace dermis::live::fleet
