// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// The checksum of recordings without libdeflate.
#include <libdeflate.h>

#include <cstdint>

#include "dermis/bytes/layouts/checksum_of.hpp"

std::uint32_t libdeflate_crc32(std::uint32_t crc, const void* data, std::size_t size) {
  using namespace dermis::bytes;  // NOLINT(google-build-using-namespace)
  static const layouts::ChecksumOf kCrcOf(layouts::kCrc32, 32);
  const std::uint32_t before = crc ^ layouts::kCrc32.final_xor;
  return kCrcOf.result(kCrcOf.add(before, {static_cast<const std::uint8_t*>(data), size}));
}
