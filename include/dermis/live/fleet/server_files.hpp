// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "dermis/touch/frames/result.hpp"

namespace dermis::live::fleet {

/// The servers of a fleet: a hub, and one on each robot, which keeps its frames while the hub is away.
struct FleetPlan {
  std::string hub{};              ///< Its name or address, as robots reach it; empty: as it was, at first 127.0.0.1.
  std::uint16_t port = 0;         ///< Clients of each server connect there; 0: as it was, at first 4222.
  std::uint16_t robots_port = 0;  ///< Servers of robots connect there to the hub; 0: as it was, at first 7422.
  std::vector<std::string> robots{};  ///< Those that come to the robots that were there.
};

/// Writes the files of a fleet's servers (nats-server), its keys and its certificates (docs/fleet.md). Returns the
/// paths of files that are new or others now. "fleet.toml" in the folder keeps the plan, so that a fleet may grow: keys
/// and the files of robots that are there stay. All are readable by their owner alone, for which the mask of modes of
/// the process changes meanwhile. Fails where the plugin is not there, on a plan that contradicts fleet.toml, and on a
/// name that is no part of a subject.
[[nodiscard]] Result<std::vector<std::string>> write_server_files(const FleetPlan& plan, const std::string& folder);

}  // namespace dermis::live::fleet
