// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/websocket/foxglove_protocol.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace dermis::out::websocket {
namespace {

using nlohmann::json;

template <typename Request>
Request parse(const std::string& text) {
  const Result<ClientRequest> request = parse_text_request(text);
  EXPECT_TRUE(request) << text;
  return std::get<Request>(*request);
}

std::vector<std::uint8_t> bytes_of(std::initializer_list<int> values) {
  std::vector<std::uint8_t> bytes;
  for (const int value : values) bytes.push_back(static_cast<std::uint8_t>(value));
  return bytes;
}

TEST(FoxgloveProtocol, prefers_the_subprotocol_that_lives) {
  EXPECT_EQ(choose_subprotocol("foxglove.websocket.v1, foxglove.sdk.v1"), "foxglove.sdk.v1");
  EXPECT_EQ(choose_subprotocol("other,foxglove.websocket.v1 "), "foxglove.websocket.v1");
  EXPECT_EQ(choose_subprotocol("foxglove.websocket.v2"), "");
  EXPECT_EQ(choose_subprotocol(""), "");
}

TEST(FoxgloveProtocol, reads_subscriptions) {
  const auto request = parse<Subscribe>(
      R"({"op":"subscribe","subscriptions":[{"id":0,"channelId":7},{"id":4294967295,"channelId":1}]})");
  ASSERT_EQ(request.subscriptions.size(), 2U);
  EXPECT_EQ(request.subscriptions[0].channel, 7U);
  EXPECT_EQ(request.subscriptions[1].id, 4294967295U);
  EXPECT_EQ(parse<Unsubscribe>(R"({"op":"unsubscribe","subscriptionIds":[3,4]})").ids,
            (std::vector<std::uint32_t>{3, 4}));
}

TEST(FoxgloveProtocol, reads_parameters_of_every_type) {
  const auto request = parse<SetParameters>(
      R"({"op":"setParameters","id":"x","parameters":[{"name":"a","value":true},{"name":"b","value":2},)"
      R"({"name":"c","value":"text"},{"name":"d","value":[1,2.5]},{"name":"e"},{"name":"f","value":null}]})");
  ASSERT_EQ(request.parameters.size(), 6U);
  EXPECT_EQ(request.id, "x");
  EXPECT_EQ(request.parameters[0].value, ParameterValue(true));
  EXPECT_EQ(request.parameters[1].value, ParameterValue(2.0));
  EXPECT_EQ(request.parameters[2].value, ParameterValue(std::string("text")));
  EXPECT_EQ(request.parameters[3].value, ParameterValue(std::vector<double>{1.0, 2.5}));
  EXPECT_EQ(request.parameters[4].value, ParameterValue());
  EXPECT_EQ(request.parameters[5].value, ParameterValue());
  EXPECT_FALSE(parse<FollowParameters>(R"({"op":"unsubscribeParameterUpdates","parameterNames":["a"]})").follow);
}

TEST(FoxgloveProtocol, refuses_what_it_is_not) {
  const std::string deep(100'000, '[');
  for (const std::string& text :
       {std::string("nonsense"), std::string("[]"), std::string("{}"), deep, std::string(R"({"op":"subscribe"})"),
        std::string(R"({"op":"subscribe","subscriptions":[1]})"),
        std::string(R"({"op":"subscribe","subscriptions":[{"id":-1,"channelId":1}]})"),
        std::string(R"({"op":"subscribe","subscriptions":[{"id":4294967296,"channelId":1}]})"),
        std::string(R"({"op":"subscribe","subscriptions":[{"id":0.5,"channelId":1}]})"),
        std::string(R"({"op":"setParameters","parameters":[{"value":1}]})"),
        std::string(R"({"op":"setParameters","parameters":[{"name":"a","value":{"b":1}}]})"),
        std::string(R"({"op":"getParameters","parameterNames":[1]})")}) {
    EXPECT_FALSE(parse_text_request(text)) << text.substr(0, 80);
  }
}

TEST(FoxgloveProtocol, errors_repeat_nothing_of_the_request) {
  for (const char* text : {R"({"op":"setParameters","parameters":[{"name":"\nevil","value":{}}]})", R"({"evil":1})",
                           R"({"op":"subscribe","subscriptions":["\nevil"]})"}) {
    const auto request = parse_text_request(text);
    ASSERT_FALSE(request);
    EXPECT_EQ(request.error().message.find("evil"), std::string::npos) << request.error().message;
  }
}

TEST(FoxgloveProtocol, ignores_what_it_does_not_offer) {
  EXPECT_TRUE(std::holds_alternative<OtherRequest>(*parse_text_request(R"({"op":"subscribeConnectionGraph"})")));
}

TEST(FoxgloveProtocol, reads_service_calls) {
  const Result<ClientRequest> request =
      parse_binary_request(bytes_of({2, 1, 0, 0, 0, 9, 0, 0, 0, 4, 0, 0, 0, 'j', 's', 'o', 'n', '{', '}'}));
  ASSERT_TRUE(request);
  const auto& call = std::get<ServiceCall>(*request);
  EXPECT_EQ(call.service, 1U);
  EXPECT_EQ(call.call, 9U);
  EXPECT_EQ(call.encoding, "json");
  EXPECT_EQ(call.request, "{}");
  EXPECT_FALSE(parse_binary_request(bytes_of({2, 1, 0, 0, 0, 9, 0, 0, 0, 255, 255, 255, 255, 'j'})));
  EXPECT_FALSE(parse_binary_request(bytes_of({77})));
  EXPECT_FALSE(parse_binary_request({}));
}

TEST(FoxgloveProtocol, reads_playback_controls) {
  // play, speed 2.0, seek to 258 ns, id "x"
  const Result<ClientRequest> request =
      parse_binary_request(bytes_of({3, 0, 0, 0, 0, 0x40, 1, 2, 1, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 'x'}));
  ASSERT_TRUE(request);
  const auto& [command, id] = std::get<PlaybackRequest>(*request);
  EXPECT_EQ(id, "x");
  EXPECT_EQ(command, (PlaybackCommand{.play = true, .speed = 2.0, .seek = Nanos(258)}));
  EXPECT_FALSE(parse_binary_request(bytes_of({3, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}))) << "speed 0";
  EXPECT_FALSE(parse_binary_request(bytes_of({3, 0, 0, 0, 0xc0, 0x7f, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0})))
      << "NaN";
}

TEST(FoxgloveProtocol, tells_how_a_playback_is) {
  const PlaybackStatus ended{PlaybackStatus::State::ended, Nanos(258), 2.0};
  EXPECT_EQ(playback_state(ended, {.command = {.seek = Nanos(1)}, .id = "x"}),
            bytes_of({5, 3, 2, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x40, 1, 1, 0, 0, 0, 'x'}));
  const PlaybackStatus paused{PlaybackStatus::State::paused, Nanos(1), 1.0};
  EXPECT_EQ(playback_state(paused, {}), bytes_of({5, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x80, 0x3f, 0, 0, 0, 0, 0}));
}

TEST(FoxgloveProtocol, says_what_it_offers) {
  const json info = json::parse(server_info_text({"dermis", "abc", true, true, {{Nanos(1'500'000'000), Nanos(7)}}}));
  EXPECT_EQ(info["op"], "serverInfo");
  EXPECT_EQ(info["capabilities"], json::array({"parameters", "parametersSubscribe", "services", "playbackControl"}));
  EXPECT_EQ(info["dataStartTime"], (json{{"sec", 1}, {"nsec", 500'000'000}}));
  const Channel channel{3, "/chest/raw", "sensor_msgs/msg/Image", "uint8 x\n"};
  const json advertised = json::parse(advertise_text({&channel, 1}))["channels"][0];
  EXPECT_EQ(advertised["id"], 3);
  EXPECT_EQ(advertised["encoding"], "cdr");
  EXPECT_EQ(advertised["schemaEncoding"], "ros2msg");
  EXPECT_EQ(advertised["schema"], "uint8 x\n");
}

TEST(FoxgloveProtocol, text_that_is_no_utf8_stays_json) {
  EXPECT_EQ(json::parse(status_text(2, "\xff broken"))["level"], 2);
}

TEST(FoxgloveProtocol, data_messages_begin_with_subscription_and_time) {
  const MessageDataHeader header = message_data_header(0x01020304, Nanos(0x0102));
  EXPECT_EQ(std::vector<std::uint8_t>(header.begin(), header.end()), bytes_of({1, 4, 3, 2, 1, 2, 1, 0, 0, 0, 0, 0, 0}));
}

}  // namespace
}  // namespace dermis::out::websocket
