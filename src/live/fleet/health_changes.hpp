// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <optional>

#include "dermis/live/fleet/robot_health.hpp"

namespace dermis::live::fleet {

/// Sees when a robot is another way than a second before.
class HealthChanges {
 public:
  /// Fills in since when each array is as it is. True: the robot is another way than in the last message, or there was
  /// none. Counts that grow are no change.
  [[nodiscard]] bool take(RobotHealth& health);

 private:
  std::optional<RobotHealth> last_;
};

}  // namespace dermis::live::fleet
