// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/fleet/hub.hpp"

#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "fleet/broker.hpp"
#include "fleet/parse_utc.hpp"
#include "fleet/streams.hpp"

namespace dermis::fleet {
namespace {

using Json = nlohmann::json;

std::string hub_file(const FleetPlan& plan) {
  return "# The hub of a fleet of dermis: nats-server -c hub.conf\n"
         "server_name: hub\n"
         "listen: \"0.0.0.0:" +
         std::to_string(plan.port) +
         "\"\n"
         "jetstream { store_dir: \"hub\", domain: \"hub\" }\n"
         "leafnodes { listen: \"0.0.0.0:" +
         std::to_string(plan.robots_port) + "\" }\n";
}

/// The robot's messages reach the hub as copies of its stream alone, so that each is there once.
std::string robot_file(const FleetPlan& plan, const std::string& robot) {
  return "# The server on robot " + robot + ": nats-server -c " + robot +
         ".conf\n"
         "server_name: " +
         robot +
         "\n"
         "listen: \"127.0.0.1:" +
         std::to_string(plan.port) +
         "\"\n"
         "jetstream { store_dir: \"" +
         robot + "\", domain: \"" + robot +
         "\" }\n"
         "leafnodes { remotes: [ { url: \"nats://" +
         plan.hub + ":" + std::to_string(plan.robots_port) + "\", deny_exports: [\"dermis.>\"] } ] }\n";
}

RobotState state_of(const Json& stream) {
  RobotState robot;
  robot.name = stream.at("config").at("name").get<std::string>().substr(stream_of("").size());
  const Json& state = stream.at("state");
  robot.messages = state.at("messages");
  robot.bytes = state.at("bytes");
  if (robot.messages > 0) robot.last = parse_utc(state.at("last_ts").get<std::string>()).value_or(Nanos{});
  robot.lag = stream.value("mirror", Json::object()).value("lag", std::uint64_t{0});
  return robot;
}

}  // namespace

Result<std::map<std::string, std::string>> server_files(const FleetPlan& plan) {
  std::map<std::string, std::string> files = {{"hub.conf", hub_file(plan)}};
  for (const std::string& robot : plan.robots) {
    if (const Status good = check_name("robot", robot); !good) return good.error();
    if (!files.emplace(robot + ".conf", robot_file(plan, robot)).second) {
      return bad_input("robot: '" + robot + "' is there twice, or the name of the hub");
    }
  }
  return files;
}

Hub::Hub(std::unique_ptr<Broker> broker) : broker_(std::move(broker)) {}

Hub::~Hub() = default;

Result<std::unique_ptr<Hub>> Hub::connect(const BrokerAddress& address) {
  Result<std::unique_ptr<Broker>> broker = connect_broker(address);
  if (!broker) return broker.error();
  return std::unique_ptr<Hub>(new Hub(*std::move(broker)));
}

Status Hub::add_robot(const std::string& name) {
  if (Status good = check_name("robot", name); !good) return good;
  return mirror_stream(*broker_, name);
}

Result<std::vector<RobotState>> Hub::robots() {
  std::vector<RobotState> robots;
  for (std::size_t total = 1, offset = 0; offset < total;) {
    const Result<std::string> answer =
        broker_->ask("$JS.API.STREAM.LIST", Json({{"offset", offset}, {"subject", ""}}).dump());
    if (!answer) return answer.error();
    const Json list = Json::parse(*answer, nullptr, false);
    if (!list.is_object() || !list.contains("streams") || !list["streams"].is_array()) break;
    total = list.value("total", std::size_t{0});
    const Json& streams = list["streams"];
    if (streams.empty()) break;
    offset += streams.size();
    try {
      for (const Json& stream : streams) {
        if (stream.at("config").at("name").get<std::string>().starts_with(stream_of(""))) {
          robots.push_back(state_of(stream));
        }
      }
    } catch (const Json::exception&) {
      return failed("the server's list of streams cannot be read");
    }
  }
  return robots;
}

}  // namespace dermis::fleet
