// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <vector>

#include "dermis/messages/live_messages.hpp"
#include "dermis/serve/served_suit.hpp"

namespace dermis::serve {

/// Where all arrays are in the suit's frame now, and then the links of its body, named "body/<link>".
[[nodiscard]] std::vector<messages::Transform> suit_transforms(const ServedSuit& suit);

}  // namespace dermis::serve
