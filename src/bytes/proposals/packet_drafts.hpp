// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bytes/proposals/draft.hpp"
#include "dermis/bytes/proposals/proposals.hpp"

namespace dermis::bytes::proposals {

/// Layouts that packets of bytes may have.
[[nodiscard]] std::vector<Draft> packet_drafts(std::span<const std::uint8_t> bytes, const Known& known);

}  // namespace dermis::bytes::proposals
