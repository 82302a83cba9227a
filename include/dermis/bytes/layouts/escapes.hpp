// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "dermis/bytes/layouts/layout.hpp"

namespace dermis::bytes::layouts {

/// The byte that stands between two packets: 0 of COBS, C0 of SLIP (RFC 1055).
[[nodiscard]] std::uint8_t delimiter_of(const PacketLayout& layout) noexcept;

/// Undoes COBS of a packet without its delimiters at the front of `plain`, which grows where it must and stays larger.
/// The size of what there is; empty where the codes lead beyond the end.
[[nodiscard]] std::optional<std::size_t> undo_cobs(std::span<const std::uint8_t> bytes,
                                                   std::vector<std::uint8_t>& plain);

/// The bytes of a packet without its delimiters; false where they cannot be one.
[[nodiscard]] bool undo_escapes(const PacketLayout& layout, std::span<const std::uint8_t> bytes,
                                std::vector<std::uint8_t>& plain);

}  // namespace dermis::bytes::layouts
