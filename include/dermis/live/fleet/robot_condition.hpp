// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "dermis/live/fleet/hub.hpp"
#include "dermis/live/fleet/robot_health.hpp"
#include "dermis/touch/frames/frames.hpp"

namespace dermis::live::fleet {

/// How a robot is, in words for people.
struct RobotCondition {
  /// From the worst on. behind: the hub still gets what the robot has told.
  enum class State : std::uint8_t { silent, unreadable, error, behind, warning, no_health, well };

  State state = State::well;
  Nanos since{};                       ///< It is so since then, by UTC; 0: not known.
  std::vector<std::string> reasons{};  ///< "chest: 2 faults". A robot that is well may have some, too.

  [[nodiscard]] bool needs_attention() const noexcept { return state != State::well; }
};

[[nodiscard]] RobotCondition condition_of(const RobotState& robot, Nanos now);
/// "silent", "no health"
[[nodiscard]] const char* to_string(RobotCondition::State state);

/// Changes from one message of a robot to the next. `before` is null for the first one that is known.
[[nodiscard]] std::vector<std::string> changes_between(const RobotHealth* before, const RobotHealth& after);

/// "model 2 wanted, 1 in use: refused since 2026-11-28 05:00:00 UTC: why"; empty: there is no model of the fleet.
[[nodiscard]] std::string model_use(const ArrayHealth& array);

/// "2026-11-28 05:00:00 UTC"
[[nodiscard]] std::string utc_text(Nanos time);

}  // namespace dermis::live::fleet
