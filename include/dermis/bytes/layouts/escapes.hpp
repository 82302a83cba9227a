// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "dermis/bytes/layouts/layout.hpp"

namespace dermis::bytes::layouts {

/// The byte that stands between two packets: 0 of COBS, C0 of SLIP (RFC 1055).
[[nodiscard]] std::uint8_t delimiter_of(const PacketLayout& layout) noexcept;

/// The bytes of a packet without its delimiters; false where they cannot be one.
[[nodiscard]] bool undo_escapes(const PacketLayout& layout, std::span<const std::uint8_t> bytes,
                                std::vector<std::uint8_t>& plain);

}  // namespace dermis::bytes::layouts
