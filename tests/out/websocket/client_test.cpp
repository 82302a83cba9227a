// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "out/websocket/client.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "out/websocket/budget.hpp"
#include "out/websocket/notice_limiter.hpp"
#include "out/websocket/taken_window.hpp"

namespace dermis::out::websocket {
namespace {

using nlohmann::json;

SharedBytes bytes_of(std::size_t size, std::uint8_t value = 0) {
  return std::make_shared<const std::vector<std::uint8_t>>(size, value);
}

TEST(OutgoingQueue, drops_the_oldest_data_and_no_control_message) {
  OutgoingQueue queue(1000);
  queue.push_text("hello");
  for (std::uint8_t i = 0; i < 10; ++i) {
    const std::size_t dropped = queue.push_data(1, Nanos(i), bytes_of(287, i));  // 300 with the header
    EXPECT_EQ(dropped, i < 3 ? 0U : 1U);
  }
  EXPECT_LE(queue.data_bytes(), 1000U);
  EXPECT_TRUE(queue.pop().is_text);
  for (const int expected : {7, 8, 9}) EXPECT_EQ(queue.pop().bytes->front(), expected);
  EXPECT_TRUE(queue.empty());
  EXPECT_EQ(queue.data_bytes(), 0U);
  EXPECT_EQ(queue.control_bytes(), 0U);
}

TEST(OutgoingQueue, holds_one_message_however_large) {
  OutgoingQueue queue(1000);
  EXPECT_EQ(queue.push_data(1, Nanos(0), bytes_of(2000)), 0U);
  EXPECT_EQ(queue.push_data(1, Nanos(0), bytes_of(3000)), 1U);
  EXPECT_EQ(queue.pop().bytes->size(), 3000U);
  EXPECT_TRUE(queue.empty());
}

using Milliseconds = std::chrono::milliseconds;

TEST(TakenWindow, is_open_to_a_client_that_tells_nothing) {
  EXPECT_TRUE(TakenWindow().is_open(1'000'000'000, 1000));
}

/// A client at the end of a line, which tells every 50 ms what came.
struct Line {
  TakenWindow window;
  double arrived = 0.0;
  std::uint64_t sent = 0;
  int tick = 0;

  /// Sends `message` bytes every 10 ms while the window is open; returns how long what is sent last will take [s].
  double send(double seconds, double bytes_per_second, std::uint64_t message) {
    double longest = 0.0;
    for (const int end = tick + static_cast<int>(100 * seconds); tick < end; ++tick) {
      arrived = std::min(static_cast<double>(sent), arrived + 0.01 * bytes_per_second);
      const TakenWindow::Clock::time_point now(Milliseconds(10 * tick));
      if (tick % 5 == 0) window.take(static_cast<std::uint64_t>(arrived), sent, now);
      if (!window.is_open(sent, message)) continue;
      sent += message;
      longest = std::max(longest, (static_cast<double>(sent) - arrived) / bytes_per_second);
    }
    return longest;
  }
};

TEST(TakenWindow, keeps_what_is_on_its_way_young_and_the_line_full) {
  for (const double rate : {12.5e3, 94e3, 10e6}) {
    Line line;
    line.send(2.0, rate, 2500);
    const std::uint64_t before = line.sent;
    EXPECT_LT(line.send(4.0, rate, 2500), 0.5) << rate;
    EXPECT_GT(static_cast<double>(line.sent - before), 0.75 * std::min(4.0 * rate, 400.0 * 2500)) << rate;
  }
}

TEST(TakenWindow, notices_within_seconds_that_a_line_has_become_slow_or_fast) {
  Line line;
  line.send(4.0, 10e6, 2500);
  line.send(6.0, 12.5e3, 2500);
  EXPECT_LT(line.send(4.0, 12.5e3, 2500), 0.5);
  line.send(2.0, 10e6, 2500);
  const std::uint64_t before = line.sent;
  line.send(1.0, 10e6, 2500);
  EXPECT_GT(line.sent - before, 90U * 2500);
}

struct StreamClient : testing::Test {
  std::vector<Parameter> parameters{{"/a", 1.0}, {"/b", true}};
  Offer offer{{[this] { return parameters; },
               [this](const Parameter& set, const std::string& client) -> Status {
                 EXPECT_EQ(client, "somebody");
                 if (set.name != "/a") return bad_input("'" + set.name + "' cannot be set");
                 parameters[0] = set;
                 return Done{};
               }},
              {{"/echo",
                [](std::string_view request) -> Result<std::string> {
                  if (request == "fail") return failed("it cannot be done");
                  return std::string(request);
                }},
               {.name = "/slow",
                .begin = [this](std::string_view request) -> Result<Later> {
                  if (request == "fail") return failed("it cannot begin");
                  return Later([this, text = std::string(request)]() -> std::optional<Result<std::string>> {
                    if (++times_asked < 3) return std::nullopt;
                    return text;
                  });
                }}},
              {}};
  int times_asked = 0;
  std::map<ChannelId, int> subscribers;
  Client client{offer,
                "somebody",
                true,
                1U << 20U,
                [this](ChannelId channel, int change) { subscribers[channel] += change; },
                [this](const Question& question) {
                  Answer answer = question();
                  while (!answer) answer = question();
                  answer(client);
                }};

  void say(const std::string& text) {
    EXPECT_TRUE(client.receive({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, true)) << text;
  }
  json next_text() {
    const OutgoingMessage message = client.queue().pop();
    EXPECT_TRUE(message.is_text);
    return json::parse(message.bytes->begin(), message.bytes->end());
  }
};

TEST_F(StreamClient, gets_what_it_subscribed_to_under_its_own_ids) {
  say(R"({"op":"subscribe","subscriptions":[{"id":5,"channelId":2},{"id":7,"channelId":3}]})");
  EXPECT_EQ(subscribers[2], 1);
  ServerStatistics statistics;
  client.publish(2, Nanos(1), bytes_of(4), MessageKind::event, statistics);
  client.publish(4, Nanos(1), bytes_of(4), MessageKind::event, statistics);
  EXPECT_EQ(statistics.messages, 1U);
  EXPECT_EQ(client.queue().pop().header->at(1), 5);
  say(R"({"op":"unsubscribe","subscriptionIds":[5,99]})");
  client.publish(2, Nanos(1), bytes_of(4), MessageKind::event, statistics);
  EXPECT_TRUE(client.queue().empty());
  EXPECT_EQ(subscribers[2], 0);
}

TEST_F(StreamClient, that_is_behind_gets_events_and_no_pictures_until_it_has_taken_them) {
  say(R"({"op":"subscribe","subscriptions":[{"id":5,"channelId":2}]})");
  say(R"({"op":"taken","bytes":0})");
  ServerStatistics statistics;
  const auto show = [&] { client.publish(2, Nanos(1), bytes_of(5000), MessageKind::picture, statistics); };
  for (int i = 0; i < 100; ++i) show();
  const std::uint64_t messages = statistics.messages;
  EXPECT_LT(messages, 10U);
  EXPECT_EQ(statistics.dropped, 100 - messages);
  client.publish(2, Nanos(1), bytes_of(5000), MessageKind::event, statistics);
  EXPECT_EQ(statistics.messages, messages + 1);
  say(R"({"op":"taken","bytes":)" + std::to_string(client.queue().binary_bytes()) + "}");
  show();
  EXPECT_EQ(statistics.messages, messages + 2);
}

TEST_F(StreamClient, that_is_behind_gets_all_pieces_of_a_time_or_none) {
  say(R"({"op":"subscribe","subscriptions":[{"id":5,"channelId":2},{"id":6,"channelId":3}]})");
  say(R"({"op":"taken","bytes":0})");
  ServerStatistics statistics;
  const auto show = [&](ChannelId channel, int time) {
    const std::uint64_t before = statistics.messages;
    client.publish(channel, Nanos(time), bytes_of(3000), MessageKind::piece, statistics);
    return statistics.messages > before;
  };
  EXPECT_TRUE(show(2, 1));
  EXPECT_FALSE(show(2, 2)) << "of another array, between the pieces of the first";
  EXPECT_TRUE(show(3, 1));
  EXPECT_FALSE(show(3, 2));
  say(R"({"op":"taken","bytes":)" + std::to_string(client.queue().binary_bytes()) + "}");
  EXPECT_FALSE(show(3, 2)) << "its first piece is missing";
  EXPECT_TRUE(show(2, 2)) << "a paused recording shows its frame again";
  EXPECT_TRUE(show(3, 2));
  EXPECT_FALSE(show(2, 1)) << "a recording goes back to a frame that was taken";
}

TEST_F(StreamClient, that_is_behind_gets_the_pieces_of_two_arrays_of_the_same_time) {
  say(R"({"op":"subscribe","subscriptions":[{"id":5,"channelId":2},{"id":6,"channelId":3}]})");
  say(R"({"op":"taken","bytes":0})");
  ServerStatistics statistics;
  for (const ChannelId channel : {2U, 3U, 2U}) {
    client.publish(channel, Nanos(1), bytes_of(3000), MessageKind::piece, statistics);
  }
  EXPECT_EQ(statistics.messages, 3U) << "2: the contacts of both";
}

TEST_F(StreamClient, that_tells_nothing_gets_all) {
  say(R"({"op":"subscribe","subscriptions":[{"id":5,"channelId":2}]})");
  ServerStatistics statistics;
  for (int moment = 0; moment < 100; ++moment) {
    client.publish(2, Nanos(1), bytes_of(5000), MessageKind::picture, statistics);
  }
  EXPECT_EQ(statistics.messages, 100U);
}

TEST_F(StreamClient, subscribes_to_a_channel_once) {
  say(R"({"op":"subscribe","subscriptions":[{"id":5,"channelId":2},{"id":6,"channelId":2},{"id":5,"channelId":3}]})");
  EXPECT_EQ(subscribers[2], 1);
  EXPECT_EQ(subscribers[3], 0);
  EXPECT_EQ(next_text()["op"], "status");
  EXPECT_EQ(next_text()["op"], "status");
}

TEST_F(StreamClient, leaves_no_subscriber_behind) {
  {
    Client other(offer, "another", true, 1U << 20U,
                 [this](ChannelId channel, int change) { subscribers[channel] += change; }, {});
    const std::string text = R"({"op":"subscribe","subscriptions":[{"id":5,"channelId":2}]})";
    EXPECT_TRUE(other.receive({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, true));
    EXPECT_EQ(subscribers[2], 1);
  }
  EXPECT_EQ(subscribers[2], 0);
}

TEST_F(StreamClient, hears_of_each_channel_once) {
  const std::vector<Channel> channels{{0, "/a", "t", "s"}, {1, "/b", "t", "s"}};
  client.greet("dermis", "session", channels);
  EXPECT_EQ(next_text()["op"], "serverInfo");
  EXPECT_EQ(next_text()["channels"].size(), 2U);
  EXPECT_EQ(next_text()["services"][0]["name"], "/echo");
  client.advertise(channels[1]);
  EXPECT_TRUE(client.queue().empty());
  client.advertise({2, "/c", "t", "s"});
  EXPECT_EQ(next_text()["channels"][0]["topic"], "/c");
}

TEST_F(StreamClient, reads_sets_and_follows_parameters) {
  say(R"({"op":"getParameters","parameterNames":[],"id":"all"})");
  json answer = next_text();
  EXPECT_EQ(answer["id"], "all");
  EXPECT_EQ(answer["parameters"].size(), 2U);
  say(R"({"op":"setParameters","parameters":[{"name":"/a","value":3}],"id":"set"})");
  answer = next_text();
  ASSERT_EQ(answer["parameters"].size(), 1U);
  EXPECT_EQ(answer["parameters"][0]["value"], 3.0);
  say(R"({"op":"subscribeParameterUpdates","parameterNames":["/a"]})");
  EXPECT_EQ(next_text()["parameters"][0]["name"], "/a");
  client.send_parameters(parameters);
  EXPECT_EQ(next_text()["parameters"].size(), 1U);
}

TEST_F(StreamClient, follows_what_there_is) {
  for (int i = 0; i < 100; ++i) {
    say(R"({"op":"subscribeParameterUpdates","parameterNames":["/no)" + std::to_string(i) + "\"]}");
  }
  client.send_parameters(std::vector<Parameter>{{"/no1", 1.0}});
  EXPECT_TRUE(client.queue().empty()) << "names that no parameter had are not kept";
  say(R"({"op":"subscribeParameterUpdates","parameterNames":[]})");
  EXPECT_EQ(next_text()["parameters"].size(), 2U);
  say(R"({"op":"unsubscribeParameterUpdates","parameterNames":["/b"]})");
  client.send_parameters(parameters);
  EXPECT_EQ(next_text()["parameters"].size(), 1U);
}

TEST_F(StreamClient, may_have_as_many_answers_wait_as_data) {
  client.greet("dermis", "session", std::vector<Channel>{{0, "/a", "t", std::string(3U << 20U, 's')}});
  EXPECT_FALSE(client.asks_and_does_not_read()) << "the greeting is not of its asking";
  client.queue().push_text(std::string(1U << 20U, 'x'));
  EXPECT_TRUE(client.asks_and_does_not_read());
}

TEST_F(StreamClient, is_told_why_a_parameter_was_not_set) {
  say(R"({"op":"setParameters","parameters":[{"name":"/b","value":3}]})");
  const json answer = next_text();
  EXPECT_EQ(answer["op"], "status");
  EXPECT_EQ(answer["message"], "'/b' cannot be set");
}

std::vector<std::uint8_t> call_of(std::uint8_t service, const std::string& request) {
  std::vector<std::uint8_t> bytes{2, service, 0, 0, 0, 9, 0, 0, 0, 4, 0, 0, 0, 'j', 's', 'o', 'n'};
  bytes.insert(bytes.end(), request.begin(), request.end());
  return bytes;
}

TEST_F(StreamClient, calls_services) {
  client.queue().push_text("first");
  const auto call = [this](std::uint8_t service, const std::string& request) {
    EXPECT_TRUE(client.receive(call_of(service, request), false));
    static_cast<void>(client.queue().pop());
  };
  call(0, "abc");
  const OutgoingMessage answer = client.queue().pop();
  EXPECT_EQ(std::string(answer.bytes->end() - 3, answer.bytes->end()), "abc");
  client.queue().push_text("first");
  call(0, "fail");
  EXPECT_EQ(next_text()["message"], "it cannot be done");
  client.queue().push_text("first");
  call(2, "abc");
  EXPECT_EQ(next_text()["op"], "serviceCallFailure");
}

TEST_F(StreamClient, asks_a_service_that_takes_its_time_until_it_has_answered) {
  EXPECT_TRUE(client.receive(call_of(1, "abc"), false));
  EXPECT_EQ(times_asked, 3);
  const OutgoingMessage answer = client.queue().pop();
  EXPECT_EQ(std::string(answer.bytes->end() - 3, answer.bytes->end()), "abc");
  EXPECT_TRUE(client.receive(call_of(1, "fail"), false));
  EXPECT_EQ(next_text()["message"], "it cannot begin");
}

TEST(Budget, gives_some_at_once_and_then_so_much_a_second) {
  using std::chrono::milliseconds;
  const auto start = Budget::Clock::now();
  Budget budget(5, 10);
  for (int i = 0; i < 5; ++i) {
    EXPECT_LE(budget.free_at(), start);
    budget.spend(1, start);
  }
  for (int i = 1; i <= 10; ++i) {
    EXPECT_NEAR(static_cast<double>((budget.free_at() - start).count()), 1e8 * (i - 1), 100.0) << i;
    budget.spend(1, start);
  }
}

TEST(Budget, makes_good_what_was_spent_beyond_it_and_saves_no_more_than_it_gives_at_once) {
  const auto start = Budget::Clock::now();
  Budget budget(5, 10);
  budget.spend(25, start);
  EXPECT_NEAR(static_cast<double>((budget.free_at() - start).count()), 2e9, 100.0);
  const auto late = start + std::chrono::hours(1);
  EXPECT_LE(budget.free_at(), late);
  budget.spend(15, late);
  EXPECT_NEAR(static_cast<double>((budget.free_at() - late).count()), 1e9, 100.0);
}

TEST(NoticeLimiter, keeps_repetitions_back_and_counts_them) {
  std::vector<std::string> lines;
  NoticeLimiter notices([&](const std::string& line) { lines.push_back(line); });
  const auto start = NoticeLimiter::Clock::now();
  for (int i = 0; i < 100; ++i) notices.notify("cut", "line", start);
  notices.notify("refused", "other", start);
  notices.notify("cut", "line", start + std::chrono::seconds(11));
  EXPECT_EQ(lines, (std::vector<std::string>{"line", "other", "line (and 99 more like it)"}));
}

}  // namespace
}  // namespace dermis::out::websocket
