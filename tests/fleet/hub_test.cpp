// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/fleet/hub.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "dermis/fleet/frame_publisher.hpp"
#include "dermis/fleet/frame_stream.hpp"
#include "nats_server.hpp"

namespace dermis::fleet {
namespace {

using std::chrono::milliseconds;

TEST(ServerFiles, are_one_for_the_hub_and_one_for_each_robot) {
  const auto files = server_files({.hub = "hub.local", .robots = {"anna", "bob"}});
  ASSERT_TRUE(files) << files.error().message;
  ASSERT_EQ(files->size(), 3U);
  EXPECT_NE(files->at("hub.conf").find("domain: \"hub\""), std::string::npos);
  EXPECT_NE(files->at("bob.conf").find("domain: \"bob\""), std::string::npos);
  EXPECT_NE(files->at("bob.conf").find("nats://hub.local:7422"), std::string::npos);
}

TEST(ServerFiles, refuse_names_that_cannot_be) {
  EXPECT_FALSE(server_files({.robots = {"a b"}}));
  EXPECT_EQ(server_files({.robots = {"a", "a"}}).error().message, "robot: 'a' is there twice, or the name of the hub");
  EXPECT_FALSE(server_files({.robots = {"hub"}}));
}

/// A hub, and a server on a robot, as the files say, on ports of their own.
class Fleet : public testing::Test {
 public:
  void SetUp() override {
    if (!support::NatsServer::is_installed()) GTEST_SKIP() << "skipped: nats-server is not installed";
    const FleetPlan plan{.port = support::free_port(), .robots_port = support::free_port(), .robots = {"anna"}};
    hub = std::make_unique<support::NatsServer>(server_files(plan)->at("hub.conf"), plan.port);
    FleetPlan on_robot = plan;
    on_robot.port = support::free_port();
    robot = std::make_unique<support::NatsServer>(server_files(on_robot)->at("anna.conf"), on_robot.port);
    auto connected = Hub::connect({hub->url()});
    if (!connected) GTEST_SKIP() << "skipped: " << connected.error().message;
    keeper = *std::move(connected);
    ASSERT_TRUE(keeper->add_robot("anna"));
    publisher =
        *FramePublisher::create({{.name = "chest", .shape = {1, 2}}}, {.broker = {robot->url()}, .robot = "anna"});
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
    const auto address = parse_stream_address(hub->url() + "?robot=anna&array=chest&from=1");
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

  std::unique_ptr<support::NatsServer> hub;
  std::unique_ptr<support::NatsServer> robot;
  std::unique_ptr<Hub> keeper;
  std::unique_ptr<FramePublisher> publisher;
  std::uint64_t next = 0;
};

TEST_F(Fleet, the_hub_has_every_frame_once_and_in_order_whoever_is_killed) {
  publish(200);
  hub->kill();
  publish(200);
  hub->start();
  publish(200);
  robot->kill();
  publish(200);
  robot->start();
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
  EXPECT_EQ(*robots->front().health, health);
  const Nanos told = robots->front().health_time;
  EXPECT_FALSE(robots->front().is_silent(told + std::chrono::seconds(1)));
  EXPECT_TRUE(robots->front().is_silent(told + kSilentAfter + Nanos(1)));
  EXPECT_TRUE(robots->front().is_silent(told - kSilentAfter - Nanos(1)));
}

TEST(FleetJson, tells_ages_and_arrays) {
  RobotState anna{.name = "anna", .last = std::chrono::seconds(99), .health = RobotHealth{.live = "http://anna/"}};
  anna.health->arrays = {{.name = "chest", .gain_change = 0.25}};
  const std::string json =
      fleet_to_json({"nats://hub", "no answer", {anna, {.name = "bob"}}}, std::chrono::seconds(100));
  for (const char* part :
       {R"("hub":"nats://hub")", R"("error":"no answer")", R"("age_s":1.0)", R"("health_age_s":null)",
        R"("live":"http://anna/")", R"("silent":true)", R"("gain_change":0.25)", R"("name":"bob")"}) {
    EXPECT_NE(json.find(part), std::string::npos) << part << " in " << json;
  }
}

TEST_F(Fleet, a_robot_may_be_added_again) {
  EXPECT_TRUE(keeper->add_robot("anna"));
  EXPECT_FALSE(keeper->add_robot("a.b"));
}

}  // namespace
}  // namespace dermis::fleet
