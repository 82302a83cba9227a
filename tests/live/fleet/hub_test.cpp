// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/fleet/hub.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "dermis/live/fleet/frame_publisher.hpp"
#include "dermis/live/fleet/frame_stream.hpp"
#include "fleet_servers.hpp"
#include "live/fleet/broker.hpp"
#include "live/fleet/name_lease.hpp"

namespace dermis::live::fleet {
namespace {

using std::chrono::milliseconds;

/// A hub, and a server on a robot, as their files say.
class Fleet : public testing::Test {
 public:
  void SetUp() override {
    if (!support::NatsServer::is_installed()) GTEST_SKIP() << "skipped: nats-server is not installed";
    auto made = support::FleetServers::start({"anna"});
    if (!made) GTEST_SKIP() << "skipped: " << made.error().message;
    servers = *std::move(made);
    auto connected = Hub::connect(servers->operator_address());
    ASSERT_TRUE(connected) << connected.error().message;
    keeper = *std::move(connected);
    ASSERT_TRUE(keeper->prepare());
    ASSERT_TRUE(keeper->add_robot("anna"));
    publisher = *FramePublisher::create({{.name = "chest", .shape = {1, 2}}},
                                        {.broker = servers->robot_address("anna"), .robot = "anna"});
  }

  void publish(std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      RawFrame frame;
      frame.time = Nanos(milliseconds(1'760'000'000'000 + 10 * static_cast<std::int64_t>(next)));
      frame.acquisition.sequence = next++;
      frame.counts = {1.0F, 2.0F};
      publisher->publish(0, frame);
      if (i % 20 == 19) std::this_thread::sleep_for(milliseconds(30));
    }
  }

  /// Waits until the hub has all, and compares.
  void expect_all_on_the_hub() const {
    const auto address = parse_stream_address(servers->operator_text() + "&robot=anna&array=chest&from=1");
    Result<std::unique_ptr<FrameStream>> stream = FrameStream::open(*address);
    for (int look = 0; look < 200 && !stream; ++look) {
      std::this_thread::sleep_for(milliseconds(100));
      stream = FrameStream::open(*address);
    }
    ASSERT_TRUE(stream) << stream.error().message;
    RawFrame frame;
    for (std::uint64_t number = 0; number < next; ++number) {
      ASSERT_TRUE(*(*stream)->next(frame));
      ASSERT_EQ(frame.acquisition.sequence, number);
    }
  }

  std::unique_ptr<support::FleetServers> servers;
  std::unique_ptr<Hub> keeper;
  std::unique_ptr<FramePublisher> publisher;
  std::uint64_t next = 0;
};

TEST_F(Fleet, the_hub_has_every_frame_once_and_in_order_whoever_is_killed) {
  publish(200);
  servers->hub().kill();
  publish(200);
  servers->hub().start();
  publish(200);
  servers->robot("anna").kill();
  publish(200);
  servers->robot("anna").start();
  publish(200);
  expect_all_on_the_hub();
}

TEST_F(Fleet, the_hub_knows_its_robots) {
  publish(100);
  expect_all_on_the_hub();
  const auto robots = keeper->robots();
  ASSERT_TRUE(robots) << robots.error().message;
  ASSERT_EQ(robots->size(), 1U);
  EXPECT_EQ(robots->front().name, "anna");
  EXPECT_GT(robots->front().messages, 1U);
  EXPECT_GT(robots->front().bytes, 100U);
  const Nanos now = std::chrono::system_clock::now().time_since_epoch();
  EXPECT_LT(now - robots->front().last, Nanos(std::chrono::minutes(1)));
}

TEST_F(Fleet, the_hub_knows_how_its_robots_are) {
  const RobotHealth health{.time = Nanos(1), .arrays = {{.name = "chest", .message = "healthy", .rate_hz = 200.0}}};
  publisher->publish(health);
  Result<std::vector<RobotState>> robots = keeper->robots();
  for (int look = 0; look < 200 && !robots->front().health; ++look) {
    std::this_thread::sleep_for(milliseconds(100));
    robots = keeper->robots();
    ASSERT_TRUE(robots) << robots.error().message;
  }
  ASSERT_TRUE(robots->front().health) << robots->front().health_error;
  RobotHealth expected = health;
  expected.arrays.front().since = health.time;  // its first message
  expected.begun = robots->front().health->begun;
  EXPECT_GT(expected.begun, Nanos{});
  EXPECT_EQ(*robots->front().health, expected);
  const Nanos told = robots->front().health_time;
  EXPECT_FALSE(robots->front().is_silent(told + std::chrono::seconds(1)));
  EXPECT_TRUE(robots->front().is_silent(told + kSilentAfter + Nanos(1)));
  EXPECT_TRUE(robots->front().is_silent(told - kSilentAfter - Nanos(1)));
}

/// Another machine that has the name on the hub.
class OtherMachine {
 public:
  explicit OtherMachine(const BrokerAddress& hub, bool takes_over = false)
      : broker_(*connect_broker(hub)),
        lease_("anna", {.token = "other", .host = "other.local", .kernel = "another", .pid = 7}, "", takes_over) {
    while (lease_.state() != NameLease::State::held) {
      EXPECT_TRUE(lease_.take(*broker_));
      std::this_thread::sleep_for(milliseconds(100));
    }
    keeper_ = std::jthread([this](const std::stop_token& stop) {
      while (!stop.stop_requested()) {
        static_cast<void>(lease_.take(*broker_));
        std::this_thread::sleep_for(milliseconds(500));
      }
    });
  }

 private:
  std::unique_ptr<Broker> broker_;
  NameLease lease_;
  std::jthread keeper_;
};

TEST_F(Fleet, a_second_machine_of_a_name_is_refused_by_the_hub) {
  publisher.reset();
  const OtherMachine other(servers->operator_address());
  const auto refused = FramePublisher::create({{.name = "chest", .shape = {1, 2}}},
                                              {.broker = servers->robot_address("anna"), .robot = "anna"});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message,
            "another robot publishes as 'anna' (process 7 on other.local); give this one another name, or have it "
            "take over");
}

TEST_F(Fleet, a_name_that_the_hub_gave_to_another_is_told_and_ends_no_robot) {
  publish(100);
  expect_all_on_the_hub();
  const std::string other = R"({"token":"other","host":"other.local","pid":7})";
  const auto hub = connect_broker(servers->operator_address());
  ASSERT_TRUE(
      (*hub)->store("$KV.dermis-names.anna", "", {reinterpret_cast<const std::uint8_t*>(other.data()), other.size()}));
  const auto is_doubled = [&] {
    publisher->publish(RobotHealth{.arrays = {{.name = "chest"}}});
    std::this_thread::sleep_for(milliseconds(100));
    const auto robots = keeper->robots();
    return robots && robots->front().health && robots->front().health->is_doubled;
  };
  bool is_told = false;
  for (int look = 0; look < 600 && !is_told; ++look) is_told = is_doubled();
  EXPECT_TRUE(is_told);
  for (int look = 0; look < 600 && is_told; ++look) is_told = is_doubled();
  EXPECT_FALSE(is_told);  // its lease has ended
  publish(100);
  expect_all_on_the_hub();
}

TEST_F(Fleet, a_machine_that_takes_the_name_over_ends_the_other) {
  publish(100);
  expect_all_on_the_hub();
  const OtherMachine other(servers->operator_address(), true);
  for (int look = 0; look < 600 && publisher->left_out(0) == 0; ++look) publish(20);
  EXPECT_GT(publisher->left_out(0), 0U);
}

TEST(FleetJson, tells_ages_and_arrays) {
  RobotState anna{.name = "anna", .last = std::chrono::seconds(99), .health = RobotHealth{.live = "http://anna/"}};
  anna.health->arrays = {{.name = "chest", .gain_change = 0.25}};
  const std::string json =
      fleet_to_json({"nats://hub", "no answer", {anna, {.name = "bob"}}, "full"}, std::chrono::seconds(100));
  for (const char* part : {R"("hub":"nats://hub")", R"("error":"no answer")", R"("age_s":1.0)",
                           R"("health_age_s":null)", R"("live":"http://anna/")", R"("silent":true)", R"("stale":true)",
                           R"("full":"full")", R"("gain_change":0.25)", R"("name":"bob")"}) {
    EXPECT_NE(json.find(part), std::string::npos) << part << " in " << json;
  }
}

TEST_F(Fleet, a_robot_may_be_added_again) {
  EXPECT_TRUE(keeper->add_robot("anna"));
  EXPECT_FALSE(keeper->add_robot("a.b"));
}

}  // namespace
}  // namespace dermis::live::fleet
