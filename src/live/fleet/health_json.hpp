// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <string>
#include <vector>

#include "dermis/live/fleet/robot_health.hpp"
#include "live/fleet/json_values.hpp"

namespace dermis::live::fleet {

[[nodiscard]] Json arrays_to_json(const std::vector<ArrayHealth>& arrays);

/// On one line. Bytes that are not UTF-8 are replaced.
[[nodiscard]] inline std::string json_text(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace dermis::live::fleet
