// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/fleet/robot_health.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <string>

namespace dermis::live::fleet {
namespace {

const ArrayHealth kChest{.name = "chest",
                         .shape = {16, 16},
                         .model = "chest.safetensors",
                         .level = ArrayHealth::Level::warning,
                         .message = "2 faults",
                         .since = Nanos(5),
                         .rate_hz = 199.5,
                         .lost = 3,
                         .left_out = 4,
                         .masked_taxels = 17,
                         .gain_change = 0.09,
                         .wants_calibration = true,
                         .damaged = 5,
                         .late = 6,
                         .wanted_model = 2,
                         .used_model = 1,
                         .refusal = "it is of another pitch",
                         .refused = Nanos(7)};

std::string with_array(const std::string& fields) {
  return R"({"arrays": [{)" + fields + "}]}";
}

TEST(RobotHealth, comes_out_as_it_went_in) {
  const RobotHealth health{.time = std::chrono::seconds(1'760'000'000),
                           .begun = Nanos(3),
                           .before = Nanos(2),
                           .is_doubled = true,
                           .free_bytes = 17,
                           .live = "http://anna:8080/",
                           .arrays = {kChest, {.name = "back"}}};
  const Result<RobotHealth> read = health_from_json(health_to_json(health));
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(*read, health);
}

TEST(RobotHealth, any_text_is_read_or_refused) {
  const std::string whole = health_to_json({.live = "http://anna:8080/", .arrays = {kChest}});
  for (std::size_t bytes = 0; bytes < whole.size(); ++bytes) EXPECT_FALSE(health_from_json(whole.substr(0, bytes)));
  for (const char* text : {"", "[]", "7", "{}", R"({"arrays": {}})", R"({"arrays": [1]})", "\xff"}) {
    EXPECT_FALSE(health_from_json(text)) << text;
  }
  EXPECT_FALSE(health_from_json(std::string(2U << 20U, '[')));
  EXPECT_FALSE(health_from_json(std::string(500'000, '[')));
  std::string many = R"({"arrays": [{})";
  for (int k = 0; k < 1000; ++k) many += ",{}";
  EXPECT_EQ(health_from_json(many + "]}").error().message, "health: tells of more than 1000 arrays");
}

TEST(RobotHealth, values_of_another_type_are_as_absent) {
  const auto read = health_from_json(with_array(
      R"("name": 7, "rows": -1, "rate_hz": "fast", "lost": 1.5, "gain_change": [], "wants_calibration": "yes")"));
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->arrays.front(), ArrayHealth({.name = "", .level = ArrayHealth::Level::error}));
}

TEST(RobotHealth, texts_are_short_and_control_neither_a_terminal_nor_the_direction_of_others) {
  const std::string fields =
      R"("name": "a\u001b[2Jb\n\u202ec\u2066", "message": ")" + std::string(199, 'm') + "\u00e9\"";
  const auto read = health_from_json(with_array(fields));
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->arrays.front().name, "a?[2Jb??c?");
  EXPECT_EQ(read->arrays.front().message, std::string(199, 'm'));
}

TEST(RobotHealth, an_address_is_of_the_web) {
  const auto live_of = [](const std::string& address) {
    return health_from_json(R"({"arrays": [], "live": ")" + address + "\"}")->live;
  };
  EXPECT_EQ(live_of("https://anna.local:8080/"), "https://anna.local:8080/");
  EXPECT_EQ(live_of("http://[::1]:8080/"), "http://[::1]:8080/");
  for (const char* bad : {"javascript:alert(1)", "http://user:password@anna/", "http://a/?token=secret", "file:///etc",
                          "http://a/'onclick='b"}) {
    EXPECT_EQ(live_of(bad), "") << bad;
  }
}

}  // namespace
}  // namespace dermis::live::fleet
