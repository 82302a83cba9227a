// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "dermis/core/surface.hpp"
#include "dermis/live/live_suit.hpp"

namespace dermis::serve {

/// The contacts of a frame of an array, as /contacts.
void encode_contacts_in_suit(const std::string& array, const ArraySurface& surface, const live::ArrayResult& result,
                             std::vector<std::uint8_t>& message);

}  // namespace dermis::serve
