// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>

#include "dermis/live/fleet/server_files.hpp"

/// Files of nats-server. On the hub each robot has an account of its own, where nobody but its server is. The account
/// FLEET has the copies of their streams, the jobs and the models. It and a robot reach of each other what is named.
namespace dermis::live::fleet {

/// Users of the account FLEET of the hub, by their public nkeys.
struct FleetUsers {
  std::string operator_key;  ///< May do all.
  std::string worker_key;    ///< Does jobs, and reads.
};

[[nodiscard]] std::string hub_text(const FleetPlan& plan, const FleetUsers& users);

/// `user`: the public nkey of those who publish and read on the robot.
[[nodiscard]] std::string robot_text(const FleetPlan& plan, const std::string& robot, const std::string& user);

/// The name of a robot's server in its certificate. It is no name of a machine, so no robot can pass for a hub.
[[nodiscard]] std::string robot_user(const std::string& robot);

}  // namespace dermis::live::fleet
