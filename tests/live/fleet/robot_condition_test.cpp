// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/fleet/robot_condition.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <vector>

namespace dermis::live::fleet {
namespace {

using State = RobotCondition::State;
using std::chrono::seconds;

constexpr Nanos kNow = seconds(1'760'000'000);

ArrayHealth refusing() {
  return {.name = "chest",
          .level = ArrayHealth::Level::warning,
          .wanted_model = 2,
          .used_model = 1,
          .refusal = "it is of another pitch",
          .refused = seconds(1'759'999'000)};
}

RobotState robot_with(const ArrayHealth& array) {
  return {.name = "anna", .messages = 7, .health = RobotHealth{.arrays = {array}}, .health_time = kNow};
}

State state_of(const RobotState& robot) {
  return condition_of(robot, kNow).state;
}

TEST(RobotCondition, a_robot_is_as_its_worst_array) {
  RobotState robot = robot_with({.name = "chest", .message = "healthy"});
  EXPECT_EQ(state_of(robot), State::well);
  EXPECT_FALSE(condition_of(robot, kNow).needs_attention());
  robot.health->arrays.push_back({.name = "back", .level = ArrayHealth::Level::warning, .message = "2 faults"});
  EXPECT_EQ(state_of(robot), State::warning);
  robot.health->arrays.push_back({.name = "arm", .level = ArrayHealth::Level::error, .since = Nanos(5)});
  EXPECT_EQ(state_of(robot), State::error);
  EXPECT_EQ(condition_of(robot, kNow).since, Nanos(5));
}

TEST(RobotCondition, a_refused_model_is_a_warning_with_its_reason_and_time) {
  const RobotCondition condition = condition_of(robot_with(refusing()), kNow);
  EXPECT_EQ(condition.state, State::warning);
  EXPECT_EQ(condition.since, refusing().refused);
  EXPECT_EQ(condition.reasons,
            std::vector<std::string>{"chest: model 2 wanted, 1 in use: refused since 2025-10-09 08:36:40 UTC: it is of "
                                     "another pitch"});
}

TEST(RobotCondition, silence_and_what_is_still_to_come_are_told_apart) {
  RobotState robot = robot_with({.name = "chest"});
  robot.health_time = kNow - seconds(60);
  EXPECT_EQ(state_of(robot), State::silent);
  EXPECT_EQ(condition_of(robot, kNow).since, kNow - seconds(60));
  EXPECT_EQ(condition_of(robot, kNow).reasons,
            std::vector<std::string>{"no message for 60 s: look whether it is on, publishes and reaches the hub"});
  robot.lag = 300;
  EXPECT_EQ(state_of(robot), State::behind);
  EXPECT_EQ(condition_of(robot, kNow).reasons, std::vector<std::string>{"the hub still lacks 300 of its messages"});
  robot.lag = 0;
  robot.comes = true;
  EXPECT_EQ(condition_of(robot, kNow).reasons, std::vector<std::string>{"its messages reach the hub 60 s late"});
  robot.health_time = kNow + seconds(60);
  EXPECT_EQ(state_of(robot), State::silent);
  EXPECT_NE(condition_of(robot, kNow).reasons.front().find("clock"), std::string::npos);
}

TEST(RobotCondition, a_robot_that_has_just_gone_silent_says_so_before_its_state_does) {
  RobotState robot = robot_with({.name = "chest"});
  EXPECT_FALSE(robot.is_stale(kNow + seconds(3)));
  EXPECT_TRUE(robot.is_stale(kNow + seconds(4)));
  EXPECT_EQ(condition_of(robot, kNow + seconds(4)).reasons, std::vector<std::string>{"no message for 4 s"});
  EXPECT_EQ(condition_of(robot, kNow + seconds(4)).state, State::well);
  robot.comes = true;  // its clock is not that of the hub
  EXPECT_FALSE(robot.is_stale(kNow + seconds(4)));
}

TEST(RobotCondition, a_full_disk_and_a_name_of_two_robots_are_reasons) {
  RobotState robot = robot_with({.name = "chest"});
  robot.health->free_bytes = 500'000'000;
  EXPECT_EQ(state_of(robot), State::warning);
  EXPECT_EQ(condition_of(robot, kNow).reasons, std::vector<std::string>{"its disk has 0.50 GB left"});
  robot.health->is_doubled = true;
  EXPECT_EQ(state_of(robot), State::error);
}

TEST(RobotCondition, what_changes_is_told_in_words) {
  RobotHealth before{.time = kNow, .begun = kNow, .before = kNow - seconds(100), .arrays = {{.name = "chest"}}};
  EXPECT_EQ(changes_between(nullptr, before),
            std::vector<std::string>{"begins to publish; it was silent since 2025-10-09 08:51:40 UTC"});
  RobotHealth after = before;
  EXPECT_TRUE(changes_between(&before, after).empty());
  after.time += seconds(50);
  after.arrays = {refusing()};
  EXPECT_EQ(changes_between(&before, after), (std::vector<std::string>{"chest: model 1 of the fleet is in use",
                                                                       "chest: model 2 is refused: it is of another "
                                                                       "pitch"}));
  EXPECT_EQ(changes_between(&after, before).back(), "chest: well");
  EXPECT_EQ(changes_between(nullptr, after).front(), "chest: model 1 of the fleet is in use");  // it began long before
}

}  // namespace
}  // namespace dermis::live::fleet
