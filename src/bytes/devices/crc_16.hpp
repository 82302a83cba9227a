// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstdint>
#include <span>

namespace dermis::bytes::devices {

/// CRC-16-CCITT: polynomial 0x1021, begins with 0xFFFF, high bit first.
[[nodiscard]] std::uint16_t crc_16(std::span<const std::uint8_t> bytes) noexcept;

}  // namespace dermis::bytes::devices
