// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "commands.hpp"
#include "dermis/live/fleet/hub.hpp"
#include "dermis/out/websocket/server.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::app {

/// Where a robot seems silent, the hub is asked twice: messages that come late tell that it is just behind.
[[nodiscard]] Result<std::vector<live::fleet::RobotState>> robots_seen_twice(live::fleet::Hub& hub);

struct PageOptions {
  std::string hub;
  out::websocket::ServerOptions server{};
  std::string token_file{};
};

/// The page of a fleet, until stop_flag(). `goes_on` is asked once a second; its error ends the page.
[[nodiscard]] Status serve_fleet_page(PageOptions& options, const std::function<Status()>& goes_on = {});

/// `dermis fleet list`, `history` and `page`: the robots of a hub.
void add_fleet_list(Command& fleet);
void add_fleet_history(Command& fleet);
void add_fleet_page(Command& fleet);
/// `dermis fleet watch`: alarms.
void add_fleet_watch(Command& fleet);
/// `dermis fleet try`: a fleet to look at.
void add_fleet_try(Command& fleet);

}  // namespace dermis::app
