// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace dermis::recordings {

/// CRC-32 as in zlib, of bytes that follow those of `crc`; 0 to begin. SIMD (Highway, run-time dispatch).
[[nodiscard]] std::uint32_t crc32(std::uint32_t crc, std::span<const std::uint8_t> bytes) noexcept;

}  // namespace dermis::recordings
