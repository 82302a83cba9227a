// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/serve/health/threat_publisher.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bytes/ros_messages/read_by_definition.hpp"
#include "dermis/bytes/recordings/mcap.hpp"
#include "out/serve/named_touches.hpp"
#include "out/serve/part_calls.hpp"
#include "out/serve/small_suit.hpp"
#include "out/serve/stream_client.hpp"
#include "support/temporary_folder.hpp"

namespace dermis::out::serve {
namespace {

using nlohmann::json;

constexpr Nanos kFrame{10'000'000};
// States of dermis_msgs/Threat.
constexpr int kClear = 0;
constexpr int kActive = 2;
constexpr int kLatched = 3;

live::threats::ThreatLimits limits(bool latched) {
  live::threats::ThreatLimits limits;
  limits.zones = {{"neck", "chest", 0, 1, 0, 1}};
  limits.limits = {{.name = "pushed", .quantity = live::threats::ThreatQuantity::total_force, .limit = 10.0},
                   {.name = "throat",
                    .quantity = live::threats::ThreatQuantity::taxel_force,
                    .limit = 5.0,
                    .latched = latched,
                    .zone = "neck"}};
  return limits;
}

/// One array under limits, its recording and a client that listens to "/threat".
class Watching : public testing::Test {
 protected:
  void watch(bool latched) {
    suit_ = small_suit({"chest"}, stop_);
    suit_.threats = limits(latched);
    websocket::ServerOptions options;
    options.port = 0;
    Result<std::unique_ptr<websocket::Server>> created = websocket::Server::create(options, {});
    ASSERT_TRUE(created) << created.error().message;
    server_ = *std::move(created);
    ASSERT_TRUE(recorder_.begin());
    auto monitors = threat_monitors(suit_);
    ASSERT_TRUE(monitors) << monitors.error().message;
    topics_ = Topics::create(*server_, {}).value();
    publisher_.emplace(suit_, *std::move(monitors), ThreatPublisher::make_topic(*topics_, recorder_).value(),
                       [this](const std::string& line) { lines_.push_back(line); });
    end_ = server_->add_channel("/end", "none", "");
    const auto none = [] { return std::vector<websocket::Parameter>{}; };
    server_->start({none, [](const websocket::Parameter&, const std::string&) { return Done{}; }});
    client_ = std::make_unique<StreamClient>(server_->port());
    client_->subscribe({"/threat", "/end"});
  }

  void press(std::size_t taxel, float newtons) {
    time_ += kFrame;
    std::vector<float> forces(kRows * kCols);
    forces[taxel] = newtons;
    const ForceFrame force = force_frame(time_, forces);
    publisher_->hear({0, {}, {}, force, {}, {}});
  }

  /// What was said since the last call.
  std::vector<json> heard() {
    server_->publish(end_, {}, std::vector<std::uint8_t>{1});
    std::vector<json> all;
    for (auto message = client_->next_message(); message.topic != "/end"; message = client_->next_message()) {
      all.push_back(bytes::ros_messages::read_by_definition(bytes::ros_messages::threat_type(), message.bytes));
    }
    return all;
  }

  /// The states of a limit that began or ended.
  std::vector<int> changes(const std::string& name) {
    std::vector<int> states;
    for (const json& threat : heard()) {
      if (threat["name"] == name && threat["changed"] == true) states.push_back(threat["state"]);
    }
    return states;
  }

  const support::TemporaryFolder folder_;
  const std::atomic<bool> stop_ = false;
  ServedSuit suit_;
  std::unique_ptr<websocket::Server> server_;
  std::unique_ptr<Topics> topics_;
  SuitRecorder recorder_{
      folder_.file("rec.mcap"),
      [] {
        return std::vector<bytes::recordings::RecordedArray>{{.name = "chest", .shape = {kRows, kCols}}};
      },
      [](const std::string& why) { ADD_FAILURE() << why; }};
  std::optional<ThreatPublisher> publisher_;
  websocket::ChannelId end_ = 0;
  std::unique_ptr<StreamClient> client_;
  std::vector<std::string> lines_;
  Nanos time_{};
};

TEST_F(Watching, a_threat_is_told_with_the_time_of_its_first_crossing) {
  watch(false);
  press(0, 1.0F);
  static_cast<void>(heard());
  press(0, 6.0F);
  const std::vector<json> all = heard();
  ASSERT_EQ(all.size(), 1U) << "the other limit is not crossed";
  const json& threat = all[0];
  EXPECT_EQ(threat["name"], "throat");
  EXPECT_EQ(threat["array"], "chest");
  EXPECT_EQ(threat["zone"], "neck");
  EXPECT_EQ(threat["quantity"], "taxel_force");
  EXPECT_EQ(threat["state"], kActive);
  EXPECT_EQ(threat["changed"], true);
  EXPECT_EQ(threat["crossed_time"], json({{"sec", 0}, {"nanosec", 20'000'000}}));
  EXPECT_EQ(threat["value"], 6.0);
  EXPECT_EQ(threat["limit"], 5.0);
  EXPECT_EQ(threat["unit"], "N");
  ASSERT_EQ(lines_.size(), 1U);
  EXPECT_TRUE(lines_[0].starts_with("threat 'throat' on 'chest': taxel force 6.0 \u00b1 0.0 N, limit 5, at x "))
      << lines_[0];
}

TEST_F(Watching, its_end_is_told_too_and_outside_of_the_zone_nothing_begins) {
  watch(false);
  press(0, 6.0F);
  press(0, 0.0F);
  EXPECT_EQ(changes("throat"), (std::vector<int>{kActive, kClear}));
  press(kRows * kCols - 1, 6.0F);
  EXPECT_EQ(changes("throat"), std::vector<int>{});
}

TEST_F(Watching, a_latched_threat_stands_until_it_is_reset) {
  watch(true);
  press(0, 6.0F);
  for (int frame = 0; frame < 60; ++frame) press(0, 0.0F);
  const std::vector<json> all = heard();
  EXPECT_EQ(all.back()["name"], "throat");
  EXPECT_EQ(all.back()["state"], kLatched);
  ASSERT_TRUE(call(*publisher_, "/threats/reset", "{}"));
  press(0, 0.0F);
  EXPECT_EQ(changes("throat"), std::vector<int>{kClear});
}

TEST_F(Watching, the_health_has_a_row_for_a_threat_while_it_is_there) {
  watch(true);
  press(0, 1.0F);
  EXPECT_TRUE(diagnoses_of(*publisher_).empty());
  press(0, 6.0F);
  ASSERT_EQ(diagnoses_of(*publisher_).size(), 1U);
  const bytes::ros_messages::Diagnosis there = diagnoses_of(*publisher_).front();
  EXPECT_EQ(there.level, bytes::ros_messages::Diagnosis::Level::error);
  EXPECT_EQ(there.name, "threat 'throat' on 'chest'");
  EXPECT_TRUE(there.message.starts_with("taxel force 6.0 \u00b1 0.0 N, limit 5, at x ")) << there.message;
  EXPECT_EQ(there.values[0], (std::pair<std::string, std::string>{"state", "there"}));
  EXPECT_EQ(there.values[2], (std::pair<std::string, std::string>{"first crossed", "0.020 s"}));
  for (int frame = 0; frame < 60; ++frame) press(0, 0.0F);
  EXPECT_EQ(diagnoses_of(*publisher_).front().values[0].second, "over, until it is reset");
  EXPECT_TRUE(diagnoses_of(*publisher_).front().values[1].second.starts_with("taxel force 6.0")) << "the worst";
  ASSERT_TRUE(call(*publisher_, "/threats/reset", "{}"));
  press(0, 0.0F);
  EXPECT_TRUE(diagnoses_of(*publisher_).empty());
}

TEST_F(Watching, all_limits_are_told_twice_a_second_and_a_line_is_logged_once_a_second) {
  watch(false);
  for (int frame = 0; frame < 300; ++frame) press(0, frame % 2 == 0 ? 6.0F : 0.0F);
  std::size_t unchanged = 0;
  for (const json& threat : heard()) unchanged += threat["name"] == "pushed" ? 1 : 0;
  EXPECT_EQ(unchanged, 6U);
  EXPECT_EQ(lines_.size(), 3U);
}

TEST_F(Watching, the_recording_holds_what_began_and_ended) {
  watch(false);
  for (int frame = 0; frame < 200; ++frame) press(0, frame == 50 ? 6.0F : 0.0F);
  ASSERT_TRUE(recorder_.end());
  const auto reader = bytes::recordings::McapReader::open(folder_.file("rec.mcap"));
  ASSERT_TRUE(reader) << reader.error().message;
  std::vector<int> states;
  bytes::recordings::McapMessage message;
  for (auto more = (*reader)->next(message); more && *more; more = (*reader)->next(message)) {
    const bytes::recordings::McapChannel& channel = (*reader)->channels().at(message.channel);
    EXPECT_EQ(channel.topic, "/threat");
    EXPECT_EQ(channel.schema_name, "dermis_msgs/msg/Threat");
    states.push_back(
        bytes::ros_messages::read_by_definition(bytes::ros_messages::threat_type(), message.data)["state"]);
  }
  EXPECT_EQ(states, (std::vector<int>{kActive, kClear}));
}

TEST(ThreatPublisher, a_limit_that_is_crossed_but_has_not_lasted_is_no_threat_yet) {
  const live::threats::ThreatLimit limit{.name = "pushed", .limit = 10.0};
  live::threats::ThreatState state;
  state.now.value = 12.0;
  EXPECT_EQ(state_of(limit, state), bytes::ros_messages::Threat::State::clear);
  state.phase = live::threats::ThreatPhase::crossed;
  EXPECT_EQ(state_of(limit, state), bytes::ros_messages::Threat::State::crossed);
  state.phase = live::threats::ThreatPhase::standing;
  EXPECT_EQ(state_of(limit, state), bytes::ros_messages::Threat::State::active);
}

}  // namespace
}  // namespace dermis::out::serve
