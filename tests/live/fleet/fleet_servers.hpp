// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "dermis/live/fleet/server_files.hpp"
#include "dermis/live/fleet/stream_address.hpp"
#include "nats_server.hpp"

namespace dermis::support {

/// The servers of a fleet, with their files as they are written, on ports of their own.
class FleetServers {
 public:
  [[nodiscard]] static Result<std::unique_ptr<FleetServers>> start(std::vector<std::string> robots) {
    auto servers = std::unique_ptr<FleetServers>(new FleetServers(std::move(robots)));
    const auto written = live::fleet::write_server_files(servers->plan_, servers->file(""));
    if (!written) return written.error();
    servers->hub_ = std::make_unique<NatsServer>(servers->file("hub"), servers->plan_.port);
    for (const std::string& robot : servers->plan_.robots) servers->start_robot(robot);
    return servers;
  }
  void start_robot(const std::string& name) {
    robots_[name] = std::make_unique<NatsServer>(file("robots/" + name), free_port());
  }

  [[nodiscard]] std::string file(const std::string& name) const { return folder_.file(name); }
  [[nodiscard]] const live::fleet::FleetPlan& plan() const { return plan_; }
  [[nodiscard]] NatsServer& hub() const { return *hub_; }
  [[nodiscard]] NatsServer& robot(const std::string& name) const { return *robots_.at(name); }

  [[nodiscard]] live::fleet::BrokerAddress hub_address(const std::string& seed) const {
    return {hub_->url(), file("ca.pem"), seed.empty() ? "" : file(seed)};
  }
  [[nodiscard]] live::fleet::BrokerAddress operator_address() const { return hub_address("operator.seed"); }
  [[nodiscard]] std::string operator_text() const {
    return hub_->url() + "?ca=" + file("ca.pem") + "&key=" + file("operator.seed");
  }
  [[nodiscard]] live::fleet::BrokerAddress robot_address(const std::string& name) const {
    return {robots_.at(name)->url(), "", file("robots/" + name + "/" + name + ".seed")};
  }

 private:
  explicit FleetServers(std::vector<std::string> robots)
      : plan_{.port = free_port(), .robots_port = free_port(), .robots = std::move(robots)} {}

  TemporaryFolder folder_;
  const live::fleet::FleetPlan plan_;
  std::unique_ptr<NatsServer> hub_;
  std::map<std::string, std::unique_ptr<NatsServer>> robots_;
};

}  // namespace dermis::support
