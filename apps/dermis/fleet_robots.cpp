// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "fleet_robots.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "dermis/live/fleet/hub.hpp"
#include "dermis/live/fleet/robot_condition.hpp"
#include "dermis/out/websocket/server.hpp"
#include "fleet_connection.hpp"
#include "server_options.hpp"
#include "status_line.hpp"
#include "stop_flag.hpp"
#include "viewer/viewer_assets.hpp"

namespace dermis::app {
namespace {

constexpr std::chrono::seconds kLookEvery{1};
constexpr std::chrono::milliseconds kSecondLook{1500};
constexpr std::uint16_t kPagePort = 8090;
constexpr std::size_t kTimeDigits = 19;  // without "UTC"
constexpr int kLooksToHistory = 10;
constexpr std::chrono::hours kShownHistory{24};

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

/// "arrays frames/s lost masked drift disk", or dashes. A robot of which nothing comes has no rate.
std::string figures_of(const live::fleet::RobotState& robot) {
  if (!robot.health) return fmt::format("{:>6} {:>9} {:>8} {:>7} {:>6} {:>9}", "-", "-", "-", "-", "-", "-");
  const Sums sums = sums_of(robot.health->arrays);
  const std::string rate = robot.is_stale(now()) ? "-" : fmt::format("{:.1f}", sums.rate_hz);
  const std::string drift = sums.most_gain_change < 0.0 ? "-" : fmt::format("{:.0f} %", 100.0 * sums.most_gain_change);
  const auto free = robot.health->free_bytes;
  const std::string disk = free ? fmt::format("{:.1f} GB", static_cast<double>(*free) / 1e9) : "-";
  return fmt::format("{:>6} {:>9} {:>8} {:>7} {:>6} {:>9}", robot.health->arrays.size(), rate, sums.lost,
                     sums.masked_taxels, drift, disk);
}

std::string since_text(Nanos since) {
  return since == Nanos{} ? "-" : live::fleet::utc_text(since).substr(0, kTimeDigits);
}

/// A line of figures, and one for each reason.
void print_robot(const live::fleet::RobotState& robot) {
  const live::fleet::RobotCondition condition = live::fleet::condition_of(robot, now());
  fmt::print("{:<24} {:<10} {:<19} {:>12} {:>10.1f} {:>12} {:>8} {}\n", robot.name,
             live::fleet::to_string(condition.state), since_text(condition.since), robot.messages,
             static_cast<double>(robot.bytes) / 1e6, age_of(robot.last), robot.lag, figures_of(robot));
  for (const std::string& reason : condition.reasons) fmt::print("  {}\n", reason);
}

}  // namespace

Result<std::vector<live::fleet::RobotState>> robots_seen_twice(live::fleet::Hub& hub) {
  Result<std::vector<live::fleet::RobotState>> robots = hub.robots();
  const auto seems_silent = [](const live::fleet::RobotState& robot) {
    return robot.is_stale(now()) && robot.health_time > Nanos{};
  };
  if (!robots || std::none_of(robots->begin(), robots->end(), seems_silent)) return robots;
  std::this_thread::sleep_for(kSecondLook);
  return hub.robots();
}

namespace {

Status list(const std::string& text) {
  const Result<std::unique_ptr<live::fleet::Hub>> hub = connect_fleet<live::fleet::Hub>(text);
  if (!hub) return hub.error();
  const Result<std::vector<live::fleet::RobotState>> robots = robots_seen_twice(**hub);
  if (!robots) return robots.error();
  if (robots->empty()) print_notice("the hub knows no robot yet: dermis fleet add HUB --robot NAME");
  if (const std::string full = (*hub)->full_disk(*robots); !full.empty()) print_notice(full);
  fmt::print("{:<24} {:<10} {:<19} {:>12} {:>10} {:>12} {:>8} {:>6} {:>9} {:>8} {:>7} {:>6} {:>9}\n", "robot", "state",
             "since (UTC)", "messages", "MB", "last before", "lag", "arrays", "frames/s", "lost", "masked", "drift",
             "disk free");
  for (const live::fleet::RobotState& robot : *robots) print_robot(robot);
  return Done{};
}

struct HistoryOptions {
  std::string hub;
  double hours = 24.0;
};

Status show_history(const HistoryOptions& options) {
  constexpr double kMostHours = 24.0 * 366.0;
  if (!(options.hours > 0.0 && options.hours <= kMostHours)) return bad_input("--hours: must be above 0, at most 8784");
  const Result<std::unique_ptr<live::fleet::Hub>> hub = connect_fleet<live::fleet::Hub>(options.hub);
  if (!hub) return hub.error();
  const Result<std::vector<live::fleet::RobotState>> robots = (*hub)->robots();
  if (!robots) return robots.error();
  const Nanos since = now() - std::chrono::duration_cast<Nanos>(std::chrono::duration<double>(3600.0 * options.hours));
  const Result<std::vector<live::fleet::RobotEvent>> events = (*hub)->history(*robots, since);
  if (!events) return events.error();
  if (events->empty()) print_notice("nothing has changed since " + live::fleet::utc_text(since));
  for (const live::fleet::RobotEvent& event : *events) {
    fmt::print("{}  {:<24} {}\n", live::fleet::utc_text(event.time), event.robot, event.text);
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

}  // namespace

Status serve_fleet_page(PageOptions& options, const std::function<Status()>& goes_on) {
  const std::atomic<bool>& stop = stop_flag();
  if (Status found = find_token(options.token_file, options.server); !found) return found;
  const Result<std::unique_ptr<live::fleet::Hub>> hub = connect_fleet<live::fleet::Hub>(options.hub);
  if (!hub) return hub.error();
  options.server.notice = print_notice;
  const Result<std::unique_ptr<out::websocket::Server>> server =
      out::websocket::Server::create(options.server, page_assets());
  if (!server) return server.error();
  const std::string shown = live::fleet::without_user_info(options.hub);
  live::fleet::FleetState fleet{.hub = shown.substr(0, shown.find('?'))};
  int looks = 0;
  const auto look = [&] {
    Result<std::vector<live::fleet::RobotState>> robots = (*hub)->robots();
    fleet.error = robots ? "" : robots.error().message;
    if (robots) fleet.robots = *std::move(robots);
    fleet.full = fleet.error.empty() ? (*hub)->full_disk(fleet.robots) : "";
    if (looks++ % kLooksToHistory == 0 && fleet.error.empty()) {
      if (const auto events = (*hub)->history(fleet.robots, now() - kShownHistory)) {
        (*server)->set_document("/history.json", "application/json", live::fleet::history_to_json(*events));
      }
    }
    (*server)->set_document("/fleet.json", "application/json", fleet_to_json(fleet, now()));
  };
  look();
  (*server)->start();
  print_notice(
      fmt::format("the fleet is shown at {} (Ctrl-C ends it)", server_address(options.server, (*server)->port())));
  while (!stop) {
    std::this_thread::sleep_for(kLookEvery);
    look();
    if (!goes_on) continue;
    if (Status goes = goes_on(); !goes) return goes;
  }
  return Done{};
}

void add_fleet_list(Command& fleet) {
  auto hub = std::make_shared<std::string>();
  Command command = fleet.subcommand("list", "The robots of a hub, how they are, and how their frames come");
  command.option("hub", *hub, "nats://HOST of the hub").required();
  command.action([hub] { return list(*hub); });
}

void add_fleet_history(Command& fleet) {
  auto options = std::make_shared<HistoryOptions>();
  Command command = fleet.subcommand("history", "When which robot changed, and how");
  command.option("hub", options->hub, "nats://HOST of the hub").required();
  command.option("--hours", options->hours, "How far back").shows_default();
  command.action([options] { return show_history(*options); });
}

void add_fleet_page(Command& fleet) {
  auto options = std::make_shared<PageOptions>();
  options->server.port = kPagePort;
  Command command = fleet.subcommand("page", "The same as a page for browsers, with the way to each robot's own");
  command.option("hub", options->hub, "nats://HOST of the hub").required();
  add_server_options(command, options->server, options->token_file);
  command.action([options] { return serve_fleet_page(*options); });
}

}  // namespace dermis::app
