// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <vector>

#include "dermis/bytes/ros_messages/live_messages.hpp"
#include "dermis/out/serve/served_suit.hpp"

namespace dermis::out::serve {

/// Where all arrays are in the suit's frame now, and then the links of its body, named "body/<link>".
[[nodiscard]] std::vector<bytes::ros_messages::Transform> suit_transforms(const ServedSuit& suit);

}  // namespace dermis::out::serve
