// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "dermis/bytes/layouts/layout.hpp"
#include "dermis/touch/frames/result.hpp"

namespace dermis::bytes::layouts {

/// "FF 0A" -> its bytes; empty where the text is anything else.
[[nodiscard]] std::optional<std::vector<std::uint8_t>> parse_bytes(std::string_view text);

/// A field as "FF FF", "values u16le", "temperature i16be *0.01" or "checksum crc16le poly=8005 init=FFFF".
[[nodiscard]] Result<PacketField> parse_packet_entry(std::string_view entry, const std::vector<LayoutArray>& arrays);

}  // namespace dermis::bytes::layouts
