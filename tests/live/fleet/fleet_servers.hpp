// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdlib>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "dermis/live/fleet/model_store.hpp"
#include "dermis/live/fleet/stream_address.hpp"
#include "nats_server.hpp"
#include "support/places.hpp"

namespace dermis::support {

/// Runs deploy/nats/make_fleet; returns its exit status. `robots`: with spaces between.
inline int make_fleet(const std::string& folder, const std::string& robots, const std::string& hub = "127.0.0.1") {
  const std::string script = (project_folder() / "deploy/nats/make_fleet").string();
  const int status =
      std::system((script + " " + folder + " '" + hub + "' " + robots + " 2>" + folder + ".said").c_str());
  return WEXITSTATUS(status);
}

inline void replace_in(const std::string& path, const std::string& from, const std::string& to) {
  std::string text = read_bytes(path);
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  write_bytes(path, text);
}

/// The servers of a fleet, with their files as they are written, on ports of their own.
class FleetServers {
 public:
  /// Fails where the plugin is not there, or the files cannot be written.
  [[nodiscard]] static Result<std::unique_ptr<FleetServers>> start(const std::vector<std::string>& robots) {
    if (const auto plugin = live::fleet::sha256(""); !plugin) return plugin.error();
    auto servers = std::unique_ptr<FleetServers>(new FleetServers());
    if (!servers->write(robots)) return failed(read_bytes(servers->folder_.file("fleet.said")));
    servers->hub_ = std::make_unique<NatsServer>(servers->file("hub"), free_port());
    for (const std::string& robot : robots) servers->start_robot(robot);
    return servers;
  }
  /// The hub reads its new file when it is told.
  [[nodiscard]] bool write(const std::vector<std::string>& robots) const {
    std::string names;
    for (const std::string& robot : robots) names += robot + " ";
    if (make_fleet(folder_.file("fleet"), names) != 0) return false;
    const std::string port = std::to_string(robots_port_);
    replace_in(file("hub/nats.conf"), "0.0.0.0:7422", "127.0.0.1:" + port);
    for (const std::string& robot : robots) replace_in(file("robots/" + robot + "/nats.conf"), ":7422", ":" + port);
    return true;
  }
  void start_robot(const std::string& name) {
    robots_[name] = std::make_unique<NatsServer>(file("robots/" + name), free_port());
  }

  [[nodiscard]] std::string file(const std::string& name) const { return folder_.file("fleet") + "/" + name; }
  [[nodiscard]] NatsServer& hub() const { return *hub_; }
  [[nodiscard]] NatsServer& robot(const std::string& name) const { return *robots_.at(name); }

  [[nodiscard]] live::fleet::BrokerAddress hub_address(const std::string& key) const {
    return {hub_->url(), file("ca.pem"), key.empty() ? "" : file(key)};
  }
  [[nodiscard]] live::fleet::BrokerAddress operator_address() const { return hub_address("operator.pem"); }
  [[nodiscard]] std::string operator_text() const {
    return hub_->url() + "?ca=" + file("ca.pem") + "&key=" + file("operator.pem");
  }
  [[nodiscard]] live::fleet::BrokerAddress robot_address(const std::string& name) const {
    return {robots_.at(name)->url(), file("ca.pem"), file("robots/" + name + "/" + name + ".pem")};
  }

 private:
  FleetServers() = default;

  TemporaryFolder folder_;
  const std::uint16_t robots_port_ = free_port();
  std::unique_ptr<NatsServer> hub_;
  std::map<std::string, std::unique_ptr<NatsServer>> robots_;
};

}  // namespace dermis::support
