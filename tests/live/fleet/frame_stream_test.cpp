// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/fleet/frame_stream.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "dermis/live/fleet/frame_publisher.hpp"
#include "live/fleet/broker.hpp"
#include "live/fleet/message_id.hpp"
#include "live/fleet/streams.hpp"
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

/// The messages of the array, as another server gets them where some bits turn on the way.
class DamagedStream : public Streaming {
 public:
  void SetUp() override {
    Streaming::SetUp();
    if (IsSkipped()) return;
    damaged = std::make_unique<support::NatsServer>();
    from = *connect_broker({server->url()});
    to = *connect_broker({damaged->url()});
    while (!make_stream(*to, "r1")) std::this_thread::sleep_for(milliseconds(50));
  }
  /// `turns(k)`: whether a bit of the k-th message of frames, or of a description, turns.
  template <typename Turns>
  void copy(const Turns& turns_frames, const Turns& turns_description, std::uint64_t session_added = 0) {
    std::size_t frames = 0;
    std::size_t descriptions = 0;
    for (std::uint64_t sequence = 1;;) {
      const auto next_frames = *from->next("dermis_r1", "dermis.r1.chest.frames", sequence);
      const auto description = *from->next("dermis_r1", "dermis.r1.chest.description", sequence);
      if (!next_frames && !description) return;
      const bool is_description = description && (!next_frames || description->sequence < next_frames->sequence);
      StoredMessage message = is_description ? *description : *next_frames;
      sequence = message.sequence + 1;
      if (is_description ? turns_description(descriptions++) : turns_frames(frames++)) {
        message.bytes[message.bytes.size() / 2] ^= 1U;
      }
      if (session_added > 0) {
        const std::uint64_t session = parse_message_id(message.id).session;
        message.id = begin_of_id(session + session_added, "chest") + message.id.substr(message.id.rfind('-') + 1);
      }
      const char* what = is_description ? "description" : "frames";
      ASSERT_TRUE(to->store(subject_of("r1", "chest", what), message.id, message.bytes));
    }
  }
  [[nodiscard]] Result<std::unique_ptr<FrameStream>> open_damaged() {
    const auto address = parse_stream_address(damaged->url() + "?robot=r1&array=chest&from=1&to=last");
    return FrameStream::open(*address, {.notice = [this](const std::string& line) { notices += line + "\n"; }});
  }
  /// Numbers of the frames.
  [[nodiscard]] static std::vector<std::uint64_t> read_all(FrameStream& stream) {
    std::vector<std::uint64_t> numbers;
    RawFrame frame;
    while (true) {
      const Result<bool> more = stream.next(frame);
      EXPECT_TRUE(more) << more.error().message;
      if (!more || !*more) return numbers;
      const std::uint64_t expected = numbers.empty() ? 0 : numbers.back() + 1;
      const std::uint64_t number = frame.acquisition.sequence.value_or(0);
      EXPECT_EQ(frame.acquisition.lost_before, number - expected);
      numbers.push_back(number);
    }
  }

  std::unique_ptr<support::NatsServer> damaged;
  std::unique_ptr<Broker> from;
  std::unique_ptr<Broker> to;
  std::string notices;
};

using Turns = std::function<bool(std::size_t)>;
const Turns kNone = [](std::size_t) { return false; };

TEST_F(DamagedStream, damaged_messages_are_gaps_that_are_named_and_counted) {
  publish(600);
  copy<Turns>([](std::size_t k) { return k % 7 == 0; }, kNone);
  const auto stream = open_damaged();
  ASSERT_TRUE(stream) << stream.error().message;
  const std::vector<std::uint64_t> numbers = read_all(**stream);
  const std::uint64_t missing = 600 - numbers.size();
  EXPECT_GT(missing, 0U);
  EXPECT_LT(missing, 300U);
  EXPECT_EQ((*stream)->statistics().damaged_frames, missing);
  EXPECT_NE(notices.find("message 2 is damaged: "), std::string::npos) << notices;
  EXPECT_NE(notices.find("lacks " + std::to_string(missing) + " frames in "), std::string::npos) << notices;
}

TEST_F(DamagedStream, another_description_is_found_where_the_first_is_damaged) {
  publish(30);
  std::this_thread::sleep_for(milliseconds(1200));
  publish(30);
  copy<Turns>(kNone, [](std::size_t k) { return k == 0; });
  const auto stream = open_damaged();
  ASSERT_TRUE(stream) << stream.error().message;
  EXPECT_EQ((*stream)->notes().array_toml, kArray.array_toml);
  EXPECT_EQ(read_all(**stream).size(), 60U);
  EXPECT_EQ(notices, "");
}

TEST_F(DamagedStream, without_a_description_it_says_so) {
  publish(30);
  copy<Turns>(kNone, [](std::size_t) { return true; });
  const auto stream = open_damaged();
  ASSERT_FALSE(stream);
  EXPECT_NE(stream.error().message.find("none of its descriptions can be read"), std::string::npos);
}

TEST_F(DamagedStream, frames_of_two_sessions_do_not_mix) {
  publish(30);
  copy<Turns>(kNone, kNone);
  copy<Turns>(kNone, kNone, 100);
  const std::uint64_t late = 1;
  ASSERT_TRUE(to->store("dermis.r1.chest.frames", begin_of_id(late, "chest") + "900.1", std::vector<std::uint8_t>{1}));
  const auto stream = open_damaged();
  ASSERT_TRUE(stream) << stream.error().message;
  RawFrame frame;
  for (std::uint64_t k = 0; k < 60; ++k) {
    ASSERT_TRUE(*(*stream)->next(frame));
    EXPECT_EQ(frame.acquisition.sequence, k % 30);
    EXPECT_EQ(frame.acquisition.lost_before, 0U);
  }
  EXPECT_FALSE(*(*stream)->next(frame));
  EXPECT_NE(notices.find("another run of the robot begins"), std::string::npos) << notices;
  EXPECT_NE(notices.find("is of another process than the one that is read"), std::string::npos) << notices;
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
