// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "live/fleet/server_texts.hpp"

#include "dermis/live/fleet/stream_address.hpp"

namespace dermis::live::fleet {
namespace {

/// A text in which each %NAME% is replaced by a value.
std::string filled(std::string text, const std::string& name, const std::string& value) {
  const std::string mark = "%" + name + "%";
  for (std::size_t at = text.find(mark); at != std::string::npos; at = text.find(mark, at + value.size())) {
    text.replace(at, mark.size(), value);
  }
  return text;
}

constexpr const char* kHub = R"(# The hub of a fleet of dermis: nats-server -c nats.conf, in the folder of this file
server_name: "hub"
listen: "0.0.0.0:%PORT%"
jetstream { store_dir: "store", domain: "hub" }
tls { cert_file: "hub.pem", key_file: "hub.key" }
leafnodes {
  listen: "0.0.0.0:%ROBOTS_PORT%"
  no_advertise: true  # robots stay with the name that they have
  # The name in a robot's certificate is its user below.
  tls { cert_file: "hub.pem", key_file: "hub.key", ca_file: "ca.pem", verify_and_map: true }
}
accounts {
  FLEET {
    jetstream: enabled
    users: [
      { nkey: "%OPERATOR%" }  # operator.seed
      { nkey: "%WORKER%", permissions: {  # worker.seed
        publish: [
          "$JS.API.STREAM.CREATE.dermis-jobs", "$JS.API.CONSUMER.DURABLE.CREATE.dermis-jobs.dermis-jobs"
          "$JS.API.CONSUMER.MSG.NEXT.dermis-jobs.dermis-jobs", "$JS.API.CONSUMER.INFO.dermis-jobs.dermis-jobs"
          "$JS.ACK.dermis-jobs.>", "$JS.API.STREAM.CREATE.dermis-outcomes", "dermis-outcomes.>"
          "$JS.API.STREAM.LIST", "$JS.API.STREAM.INFO.*", "$JS.API.DIRECT.GET.>"
        ]
        subscribe: ["_INBOX.>"]
      } }
    ]
    exports: [
%EXPORTS%    ]
    imports: [
%IMPORTS%    ]
  }
%ACCOUNTS%}
)";

// A robot reads its models.
constexpr const char* kExports =
    R"(      { service: "$JS.API.DIRECT.GET.dermis-models.dermis-models.%R%.>", accounts: ["ROBOT_%R%"] }
)";

// The hub copies the robot's stream: it asks for that, gets the messages, and says how fast it takes them.
constexpr const char* kImports =
    R"(      { service: { account: "ROBOT_%R%", subject: "$JS.%R%.API.CONSUMER.CREATE.%STREAM%" } }
      { service: { account: "ROBOT_%R%", subject: "$JS.%R%.API.CONSUMER.CREATE.%STREAM%.>" } }
      { service: { account: "ROBOT_%R%", subject: "$JS.FC.%STREAM%.>" } }
      { stream: { account: "ROBOT_%R%", subject: "dermis-mirror.%R%.>" } }
)";

constexpr const char* kAccount = R"(  "ROBOT_%R%" {
    users: [ { user: "%USER%", allowed_connection_types: ["LEAFNODE"] } ]
    exports: [
      { service: "$JS.%R%.API.CONSUMER.CREATE.%STREAM%", accounts: ["FLEET"] }
      { service: "$JS.%R%.API.CONSUMER.CREATE.%STREAM%.>", accounts: ["FLEET"] }
      { service: "$JS.FC.%STREAM%.>", accounts: ["FLEET"] }
      { stream: "dermis-mirror.%R%.>", accounts: ["FLEET"] }
    ]
    imports: [ { service: { account: "FLEET", subject: "$JS.API.DIRECT.GET.dermis-models.dermis-models.%R%.>" } } ]
  }
)";

constexpr const char* kRobot = R"(# The server on robot %R%: nats-server -c nats.conf, in the folder of this file
server_name: "%R%"
listen: "127.0.0.1:%PORT%"
jetstream { store_dir: "store", domain: "%R%" }
accounts {
  ROBOT { jetstream: enabled, users: [ { nkey: "%USER%" } ] }  # %R%.seed
}
leafnodes {
  remotes: [ {
    url: "tls://%HUB%:%ROBOTS_PORT%"
    account: "ROBOT"
    tls { cert_file: "%R%.pem", key_file: "%R%.key", ca_file: "ca.pem" }
  } ]
}
)";

std::string of_robot(const char* text, const std::string& robot) {
  return filled(filled(filled(text, "R", robot), "STREAM", stream_of(robot)), "USER", robot_user(robot));
}

std::string with_ports(const std::string& text, const FleetPlan& plan) {
  return filled(filled(text, "PORT", std::to_string(plan.port)), "ROBOTS_PORT", std::to_string(plan.robots_port));
}

}  // namespace

std::string robot_user(const std::string& robot) {
  return robot + "@robots";
}

std::string hub_text(const FleetPlan& plan, const FleetUsers& users) {
  std::string exports;
  std::string imports;
  std::string accounts;
  for (const std::string& robot : plan.robots) {
    exports += of_robot(kExports, robot);
    imports += of_robot(kImports, robot);
    accounts += of_robot(kAccount, robot);
  }
  std::string text = with_ports(kHub, plan);
  text = filled(filled(text, "OPERATOR", users.operator_key), "WORKER", users.worker_key);
  return filled(filled(filled(text, "EXPORTS", exports), "IMPORTS", imports), "ACCOUNTS", accounts);
}

std::string robot_text(const FleetPlan& plan, const std::string& robot, const std::string& user) {
  const std::string text = filled(filled(with_ports(kRobot, plan), "HUB", plan.hub), "USER", user);
  return filled(text, "R", robot);
}

}  // namespace dermis::live::fleet
