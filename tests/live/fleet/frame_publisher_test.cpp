// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/fleet/frame_publisher.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "dermis/live/fleet/frame_stream.hpp"
#include "nats_server.hpp"
#include "support/random_frames.hpp"

namespace dermis::live::fleet {
namespace {

using std::chrono::milliseconds;

const bytes::recordings::RecordedArray kArray{.name = "chest", .shape = {4, 5}, .array_toml = "[array]\n"};
constexpr Nanos kStart{1'760'000'000'000'000'000};

class Publishing : public testing::Test {
 public:
  void SetUp() override {
    if (!support::NatsServer::is_installed()) GTEST_SKIP() << "skipped: nats-server is not installed";
    server = std::make_unique<support::NatsServer>();
    const auto publisher = FramePublisher::create({kArray}, {.broker = {server->url()}, .robot = "probe"});
    if (!publisher && publisher.error().kind == ErrorKind::bad_input) {
      GTEST_SKIP() << "skipped: " << publisher.error().message;
    }
  }

  [[nodiscard]] std::unique_ptr<FramePublisher> publisher() {
    auto made = FramePublisher::create(
        {kArray}, {.broker = {server->url()}, .robot = "r1", .notice = [this](const std::string& line) {
                     const std::scoped_lock lock(mutex);
                     notices.push_back(line);
                   }});
    EXPECT_TRUE(made) << made.error().message;
    return *std::move(made);
  }

  /// All that the server has of the array.
  [[nodiscard]] std::vector<RawFrame> stored() const {
    const auto address = parse_stream_address(server->url() + "?robot=r1&array=chest&from=1&to=last");
    const auto stream = FrameStream::open(*address);
    EXPECT_TRUE(stream) << stream.error().message;
    std::vector<RawFrame> frames;
    RawFrame frame;
    while (stream && *(*stream)->next(frame)) frames.push_back(frame);
    return frames;
  }

  std::unique_ptr<support::NatsServer> server;
  std::mutex mutex;
  std::vector<std::string> notices;
};

std::vector<RawFrame> random_frames(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<RawFrame> frames;
  for (std::size_t i = 0; i < count; ++i) {
    frames.push_back(support::random_frame(random, kArray.shape.taxel_count(), support::RandomCounts::any_bits));
    frames.back().time = kStart + static_cast<std::int64_t>(i) * Nanos(milliseconds(5));
    frames.back().acquisition.lost_before = 0;
  }
  return frames;
}

void expect_same(const std::vector<RawFrame>& read, const std::vector<RawFrame>& written) {
  ASSERT_EQ(read.size(), written.size());
  for (std::size_t i = 0; i < read.size(); ++i) support::expect_same_frame(read[i], written[i]);
}

TEST_F(Publishing, stores_every_frame_once_and_in_order) {
  const std::vector<RawFrame> frames = random_frames(1000, 1);
  {
    const auto sender = publisher();
    for (const RawFrame& frame : frames) sender->publish(0, frame);
  }
  expect_same(stored(), frames);
}

TEST_F(Publishing, survives_servers_that_are_killed) {
  const std::vector<RawFrame> frames = random_frames(3000, 2);
  {
    const auto sender = publisher();
    for (std::size_t i = 0; i < frames.size(); ++i) {
      sender->publish(0, frames[i]);
      if (i % 5 == 0) std::this_thread::sleep_for(milliseconds(5));
      if (i % 1000 != 500) continue;
      server->kill();
      std::this_thread::sleep_for(milliseconds(300));
      server->start();
    }
    while (sender->counts().frames < frames.size()) std::this_thread::sleep_for(milliseconds(50));
  }
  expect_same(stored(), frames);
}

TEST_F(Publishing, a_server_that_stays_away_is_told_and_its_return) {
  const auto sender = publisher();
  const auto wait_for_notices = [&](std::size_t count) {
    for (int look = 0; look < 600; ++look) {
      std::this_thread::sleep_for(milliseconds(50));
      const std::scoped_lock lock(mutex);
      if (notices.size() >= count) return notices.back();
    }
    return std::string("no notice");
  };
  server->kill();
  sender->publish(0, random_frames(1, 6).front());
  EXPECT_NE(wait_for_notices(1).find("frames wait, and it is asked again"), std::string::npos);
  server->start();
  EXPECT_NE(wait_for_notices(2).find("stores frames again"), std::string::npos);
}

TEST_F(Publishing, begins_without_a_server_and_does_not_wait_for_it) {
  server->kill();
  const std::vector<RawFrame> frames = random_frames(100, 3);
  const auto sender = publisher();
  for (const RawFrame& frame : frames) sender->publish(0, frame);
  server->start();
  while (sender->counts().frames < frames.size()) std::this_thread::sleep_for(milliseconds(50));
  expect_same(stored(), frames);
}

TEST_F(Publishing, health_does_not_wait_for_a_server_and_frames_do_not_wait_for_it) {
  const std::vector<RawFrame> frames = random_frames(100, 7);
  const auto sender = publisher();
  server->kill();
  for (const RawFrame& frame : frames) {
    sender->publish(0, frame);
    sender->publish(RobotHealth{.live = "http://anna/"});
  }
  server->start();
  while (sender->counts().frames < frames.size()) std::this_thread::sleep_for(milliseconds(50));
  expect_same(stored(), frames);
  EXPECT_EQ(sender->left_out(0), 0U);
}

TEST_F(Publishing, another_run_of_the_robot_goes_on_in_its_stream) {
  const std::vector<RawFrame> frames = random_frames(300, 4);
  for (std::size_t run = 0; run < 3; ++run) {
    const auto sender = publisher();
    for (std::size_t i = 100 * run; i < 100 * (run + 1); ++i) sender->publish(0, frames[i]);
  }
  expect_same(stored(), frames);
}

TEST_F(Publishing, a_second_robot_of_the_name_is_refused) {
  const auto first = publisher();
  const auto second = FramePublisher::create({kArray}, {.broker = {server->url()}, .robot = "r1"});
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().kind, ErrorKind::bad_input);
  EXPECT_TRUE(second.error().message.starts_with("another robot publishes as 'r1' (process "))
      << second.error().message;
  EXPECT_TRUE(second.error().message.ends_with("; give this one another name, or have it take over"));
}

TEST_F(Publishing, who_takes_over_publishes_and_the_other_no_more) {
  const std::vector<RawFrame> frames = random_frames(300, 8);
  const auto first = publisher();
  for (std::size_t k = 0; k < 100; ++k) first->publish(0, frames[k]);
  while (first->counts().frames < 100) std::this_thread::sleep_for(milliseconds(20));
  const auto second = FramePublisher::create({kArray}, {.broker = {server->url()}, .robot = "r1", .take_over = true});
  ASSERT_TRUE(second) << second.error().message;
  const auto is_told = [this] {
    const std::scoped_lock lock(mutex);
    return !notices.empty() && notices.back().ends_with("has taken over the name 'r1'; nothing more is published");
  };
  for (int look = 0; look < 600 && !is_told(); ++look) std::this_thread::sleep_for(milliseconds(100));
  EXPECT_TRUE(is_told());
  for (std::size_t k = 100; k < 200; ++k) first->publish(0, frames[k]);
  for (std::size_t k = 200; k < 300; ++k) (*second)->publish(0, frames[k]);
  while ((*second)->counts().frames < 100) std::this_thread::sleep_for(milliseconds(20));
  while (first->left_out(0) < 100) std::this_thread::sleep_for(milliseconds(20));
  std::vector<RawFrame> expected(frames.begin(), frames.begin() + 100);
  expected.insert(expected.end(), frames.begin() + 200, frames.end());
  expect_same(stored(), expected);
}

TEST_F(Publishing, the_bandwidth_is_that_of_its_counts) {
  const auto sender = publisher();
  for (const RawFrame& frame : random_frames(200, 5)) sender->publish(0, frame);
  while (sender->counts().frames < 150) std::this_thread::sleep_for(milliseconds(20));
  EXPECT_GT(sender->counts().bytes, 150 * kArray.shape.taxel_count());
  EXPECT_EQ(sender->counts().left_out, 0U);
}

TEST(FramePublisher, names_are_parts_of_subjects) {
  const auto robot = FramePublisher::create({kArray}, {.robot = "a.b"});
  EXPECT_EQ(robot.error().message, "robot: 'a.b' must be 1 to 64 letters, digits, '_' or '-', a letter or digit first");
  EXPECT_FALSE(FramePublisher::create({kArray}, {.robot = "-rf"}));
  const auto array = FramePublisher::create({{.name = "left hand", .shape = {1, 1}}}, {.robot = "r"});
  EXPECT_EQ(array.error().message,
            "array: 'left hand' must be 1 to 64 letters, digits, '_' or '-', a letter or digit first");
}

}  // namespace
}  // namespace dermis::live::fleet
