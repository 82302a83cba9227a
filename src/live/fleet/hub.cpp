// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/live/fleet/hub.hpp"

#include <algorithm>
#include <chrono>
#include <optional>
#include <string_view>
#include <utility>

#include "dermis/live/fleet/robot_condition.hpp"
#include "live/fleet/broker.hpp"
#include "live/fleet/health_json.hpp"
#include "live/fleet/json_values.hpp"
#include "live/fleet/name_lease.hpp"
#include "live/fleet/parse_utc.hpp"
#include "live/fleet/streams.hpp"

namespace dermis::live::fleet {
namespace {

constexpr std::chrono::seconds kComesWithin{5};
constexpr std::size_t kMostRobots = 1'000'000;

RobotState state_of(const Json& stream) {
  const Json state = object_at(stream, "state");
  RobotState robot;
  robot.name = text_at(object_at(stream, "config"), "name").substr(stream_of("").size());
  robot.messages = number_at(state, "messages");
  robot.bytes = number_at(state, "bytes");
  if (robot.messages > 0) robot.last = parse_utc(text_at(state, "last_ts")).value_or(Nanos{});
  robot.lag = number_at(object_at(stream, "mirror"), "lag");
  return robot;
}

/// null: `then` is not known.
Json seconds_since(Nanos then, Nanos now) {
  if (then == Nanos{}) return nullptr;
  return std::chrono::duration<double>(now - then).count();
}

Result<RobotHealth> health_in(const StoredMessage& message) {
  return health_from_json({reinterpret_cast<const char*>(message.bytes.data()), message.bytes.size()});
}

}  // namespace

std::string fleet_to_json(const FleetState& fleet, Nanos now) {
  Json list = Json::array();
  for (const RobotState& robot : fleet.robots) {
    const RobotCondition condition = condition_of(robot, now);
    Json& json = list.emplace_back();
    json = {{"name", robot.name},
            {"state", to_string(condition.state)},
            {"since_s", seconds_since(condition.since, now)},
            {"reasons", condition.reasons},
            {"messages", robot.messages},
            {"bytes", robot.bytes},
            {"age_s", seconds_since(robot.last, now)},
            {"lag", robot.lag},
            {"health_age_s", seconds_since(robot.health_time, now)},
            {"silent", robot.is_silent(now)},
            {"stale", robot.is_stale(now)}};
    json["live"] = robot.health ? robot.health->live : "";
    json["arrays"] = robot.health ? arrays_to_json(robot.health->arrays) : Json::array();
  }
  return json_text({{"hub", fleet.hub}, {"error", fleet.error}, {"full", fleet.full}, {"robots", std::move(list)}});
}

std::string history_to_json(const std::vector<RobotEvent>& events) {
  Json list = Json::array();
  for (const RobotEvent& event : events) {
    const auto milliseconds = std::chrono::duration_cast<std::chrono::milliseconds>(event.time).count();
    list.push_back({{"time_ms", milliseconds}, {"robot", event.robot}, {"text", event.text}});
  }
  return json_text({{"events", std::move(list)}});
}

Hub::Hub(std::unique_ptr<Broker> broker) : broker_(std::move(broker)) {}

Hub::~Hub() = default;

Result<std::unique_ptr<Hub>> Hub::connect(const BrokerAddress& address) {
  Result<std::unique_ptr<Broker>> broker = connect_broker(address);
  if (!broker) return broker.error();
  return std::unique_ptr<Hub>(new Hub(*std::move(broker)));
}

Status Hub::prepare() {
  return make_leases(*broker_);
}

Status Hub::add_robot(const std::string& name) {
  if (Status good = check_name("robot", name); !good) return good;
  return mirror_stream(*broker_, name);
}

Result<std::vector<RobotState>> Hub::robots() {
  std::vector<RobotState> robots;
  for (std::size_t offset = 0, total = 1; offset < total && robots.size() < kMostRobots;) {
    const Result<std::string> answer = broker_->ask("$JS.API.STREAM.LIST", Json({{"offset", offset}}).dump());
    if (!answer) return answer.error();
    const Json list = Json::parse(*answer, nullptr, false);
    if (!list.is_object() || !list.contains("streams") || !list["streams"].is_array()) break;
    if (list["streams"].empty()) break;
    for (const Json& stream : list["streams"]) {
      const std::string name = text_at(object_at(stream, "config"), "name");
      if (name.starts_with(stream_of(""))) robots.push_back(state_of(stream));
    }
    offset += list["streams"].size();
    total = number_at(list, "total");
  }
  for (RobotState& robot : robots) {
    see_growth(robot);
    add_health(robot);
  }
  return robots;
}

void Hub::see_growth(RobotState& robot) {
  const auto now = std::chrono::steady_clock::now();
  const std::scoped_lock lock(mutex_);
  const auto [place, is_first] = growths_.try_emplace(robot.name, Growth{robot.messages, now - kComesWithin});
  Growth& growth = place->second;
  if (!is_first && growth.messages < robot.messages) growth.last = now;
  growth.messages = robot.messages;
  robot.comes = now - growth.last < kComesWithin;
}

/// A robot that tells nonsense, or whose stream does not answer, costs no other.
void Hub::add_health(RobotState& robot) {
  if (robot.messages == 0 || !check_name("robot", robot.name)) return;
  const Result<std::optional<StoredMessage>> last = broker_->last(stream_of(robot.name), health_subject_of(robot.name));
  if (!last) robot.health_error = last.error().message;
  if (!last || !*last) return;
  Result<RobotHealth> health = health_in(**last);
  robot.health_time = (*last)->time;
  if (health)
    robot.health = *std::move(health);
  else
    robot.health_error = health.error().message;
}

std::string Hub::full_disk(const std::vector<RobotState>& robots) {
  const Nanos now = std::chrono::system_clock::now().time_since_epoch();
  const auto is_stale = [&](const RobotState& robot) { return robot.is_stale(now); };
  if (std::none_of(robots.begin(), robots.end(), is_stale)) return "";
  const Status tried = try_leases(*broker_);
  if (tried || tried.error().message.find(kDiskIsFull) == std::string::npos) return "";
  return "the hub stores nothing more: " + tried.error().message;
}

Result<std::vector<RobotEvent>> Hub::history(const std::vector<RobotState>& robots, Nanos since) {
  std::vector<RobotEvent> events;
  for (const RobotState& robot : robots) {
    if (const Status added = add_events(robot, since, events); !added) return added.error();
    const RobotCondition now = condition_of(robot, std::chrono::system_clock::now().time_since_epoch());
    if (now.state == RobotCondition::State::silent && now.since >= since && now.since > Nanos{}) {
      events.push_back({now.since, robot.name, "is silent since then"});
    }
  }
  std::stable_sort(events.begin(), events.end(),
                   [](const RobotEvent& a, const RobotEvent& b) { return a.time < b.time; });
  return events;
}

Status Hub::add_events(const RobotState& robot, Nanos since, std::vector<RobotEvent>& events) {
  if (robot.messages == 0 || !check_name("robot", robot.name)) return Done{};
  const StreamSubject changes{stream_of(robot.name), changes_subject_of(robot.name)};
  const Result<std::optional<StoredMessage>> last = broker_->last(changes.stream, changes.subject);
  if (!last) return last.error();
  if (!*last) return Done{};
  Result<std::uint64_t> next = first_since(*broker_, changes, since, (*last)->sequence);
  std::optional<RobotHealth> before;
  while (next && *next <= (*last)->sequence) {
    const Result<std::optional<StoredMessage>> message = broker_->next(changes.stream, changes.subject, *next);
    if (!message) return message.error();
    if (!*message) break;
    next = (*message)->sequence + 1;
    Result<RobotHealth> health = health_in(**message);
    if (!health || (*message)->time < since) continue;
    const Nanos time = std::min(health->time, (*message)->time);
    for (std::string& text : changes_between(before ? &*before : nullptr, *health)) {
      events.push_back({time, robot.name, std::move(text)});
    }
    before = *std::move(health);
  }
  return next ? Status(Done{}) : Status(next.error());
}

}  // namespace dermis::live::fleet
