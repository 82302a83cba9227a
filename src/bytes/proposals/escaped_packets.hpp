// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bytes/proposals/packet_search.hpp"

namespace dermis::bytes::proposals {

/// Packets between delimiters, whose escapes are undone: COBS, SLIP and those of HDLC.
[[nodiscard]] std::vector<Packets> escaped_packets_in(std::span<const std::uint8_t> bytes);

}  // namespace dermis::bytes::proposals
