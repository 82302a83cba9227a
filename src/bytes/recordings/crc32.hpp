// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <libdeflate.h>

#include <cstdint>
#include <span>

namespace dermis::bytes::recordings {

/// CRC-32 as in zlib, of bytes that follow those of `crc`; 0 to begin. libdeflate's is three times as fast as zlib's.
[[nodiscard]] inline std::uint32_t crc32(std::uint32_t crc, std::span<const std::uint8_t> bytes) noexcept {
  return libdeflate_crc32(crc, bytes.data(), bytes.size());
}

}  // namespace dermis::bytes::recordings
