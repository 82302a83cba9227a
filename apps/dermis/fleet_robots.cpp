// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "fleet_robots.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "dermis/live/fleet/hub.hpp"
#include "dermis/out/websocket/server.hpp"
#include "fleet_connection.hpp"
#include "server_address.hpp"
#include "status_line.hpp"
#include "stop_flag.hpp"
#include "viewer/viewer_assets.hpp"

namespace dermis::app {
namespace {

constexpr std::chrono::seconds kLookEvery{1};
constexpr std::uint16_t kPagePort = 8090;

struct PageOptions {
  std::string hub;
  out::websocket::ServerOptions server{};
};

Nanos now() {
  return std::chrono::system_clock::now().time_since_epoch();
}

std::string age_of(Nanos last) {
  if (last == Nanos{}) return "-";
  return fmt::format("{:.3f} s", std::chrono::duration<double>(now() - last).count());
}

/// Figures of all arrays of a robot.
struct Sums {
  double rate_hz = 0.0;
  std::uint64_t lost = 0;
  std::uint64_t masked_taxels = 0;
  double most_gain_change = -1.0;  ///< Below 0: none is known.
};

Sums sums_of(const std::vector<live::fleet::ArrayHealth>& arrays) {
  Sums sums;
  for (const live::fleet::ArrayHealth& array : arrays) {
    sums.rate_hz += array.rate_hz;
    sums.lost += array.lost;
    sums.masked_taxels += array.masked_taxels;
    sums.most_gain_change = std::max(sums.most_gain_change, array.gain_change.value_or(-1.0));
  }
  return sums;
}

/// "arrays frames/s lost masked drift", or dashes.
std::string figures_of(const live::fleet::RobotState& robot) {
  if (!robot.health) return fmt::format("{:>6} {:>9} {:>8} {:>7} {:>6}", "-", "-", "-", "-", "-");
  const Sums sums = sums_of(robot.health->arrays);
  const std::string drift = sums.most_gain_change < 0.0 ? "-" : fmt::format("{:.0f} %", 100.0 * sums.most_gain_change);
  return fmt::format("{:>6} {:>9.1f} {:>8} {:>7} {:>6}", robot.health->arrays.size(), sums.rate_hz, sums.lost,
                     sums.masked_taxels, drift);
}

/// "silent", "chest: 2 faults; chest: calibrate".
std::string remarks_on(const live::fleet::RobotState& robot) {
  std::vector<std::string> remarks;
  if (!robot.health_error.empty()) remarks.push_back(robot.health_error);
  if (robot.is_silent(now())) remarks.emplace_back("silent");
  if (robot.health) {
    for (const live::fleet::ArrayHealth& array : robot.health->arrays) {
      if (array.level != live::fleet::ArrayHealth::Level::good) remarks.push_back(array.name + ": " + array.message);
      if (array.left_out > 0) {
        remarks.push_back(fmt::format("{}: {} frames were not published", array.name, array.left_out));
      }
      const bool says_so = array.message.find("calibrate") != std::string::npos;
      if (array.wants_calibration && !says_so) remarks.push_back(array.name + ": calibrate");
    }
  }
  std::string line;
  for (const std::string& remark : remarks) line += (line.empty() ? "" : "; ") + remark;
  return line;
}

Status list(const std::string& text) {
  const Result<std::unique_ptr<live::fleet::Hub>> hub = connect_fleet<live::fleet::Hub>(text);
  if (!hub) return hub.error();
  const Result<std::vector<live::fleet::RobotState>> robots = (*hub)->robots();
  if (!robots) return robots.error();
  fmt::print("{:<24} {:>12} {:>10} {:>12} {:>8} {:>12} {:>6} {:>9} {:>8} {:>7} {:>6}  {}\n", "robot", "messages", "MB",
             "last before", "lag", "told before", "arrays", "frames/s", "lost", "masked", "drift", "remarks");
  for (const live::fleet::RobotState& robot : *robots) {
    fmt::print("{:<24} {:>12} {:>10.1f} {:>12} {:>8} {:>12} {}  {}\n", robot.name, robot.messages,
               static_cast<double>(robot.bytes) / 1e6, age_of(robot.last), robot.lag, age_of(robot.health_time),
               figures_of(robot), remarks_on(robot));
  }
  return Done{};
}

/// Those of the viewer, with the page of fleets at "/".
std::vector<out::websocket::Asset> page_assets() {
  std::vector<out::websocket::Asset> assets;
  for (out::websocket::Asset asset : viewer::assets()) {
    if (asset.path == "/index.html") continue;
    if (asset.path == "/fleet.html") asset.path = "/index.html";
    assets.push_back(asset);
  }
  return assets;
}

Status serve_page(PageOptions& options) {
  const std::atomic<bool>& stop = stop_flag();
  const Result<std::unique_ptr<live::fleet::Hub>> hub = connect_fleet<live::fleet::Hub>(options.hub);
  if (!hub) return hub.error();
  options.server.notice = print_notice;
  const Result<std::unique_ptr<out::websocket::Server>> server =
      out::websocket::Server::create(options.server, page_assets());
  if (!server) return server.error();
  live::fleet::FleetState fleet{.hub = live::fleet::without_password(options.hub)};
  const auto look = [&] {
    Result<std::vector<live::fleet::RobotState>> robots = (*hub)->robots();
    fleet.error = robots ? "" : robots.error().message;
    if (robots) fleet.robots = *std::move(robots);
    (*server)->set_document("/fleet.json", "application/json", fleet_to_json(fleet, now()));
  };
  look();
  (*server)->start();
  print_notice(
      fmt::format("the fleet is shown at {} (Ctrl-C ends it)", server_address(options.server, (*server)->port())));
  while (!stop) {
    std::this_thread::sleep_for(kLookEvery);
    look();
  }
  return Done{};
}

}  // namespace

void add_fleet_list(Command& fleet) {
  auto hub = std::make_shared<std::string>();
  Command command = fleet.subcommand("list", "The robots of a hub, how they are, and how their frames come");
  command.option("hub", *hub, "nats://HOST of the hub").required();
  command.action([hub] { return list(*hub); });
}

void add_fleet_page(Command& fleet) {
  auto options = std::make_shared<PageOptions>();
  options->server.port = kPagePort;
  Command command = fleet.subcommand("page", "The same as a page for browsers, with the way to each robot's own");
  command.option("hub", options->hub, "nats://HOST of the hub").required();
  command.option("--host", options->server.host, "Address to serve at; all but loopback need a token").shows_default();
  command.option("--port", options->server.port, "Port; 0: any that is free").shows_default();
  command.option("--token", options->server.token, "Every client must present it");
  command.action([options] { return serve_page(*options); });
}

}  // namespace dermis::app
