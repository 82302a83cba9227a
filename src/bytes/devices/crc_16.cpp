// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/devices/crc_16.hpp"

#include <array>
#include <cstddef>

namespace dermis::bytes::devices {
namespace {

// Eight bytes at a time: the CRC is linear, so the remainders of the eight add up. Source: Kounavis, Berry, "Novel
// Table Lookup-Based Algorithms for High-Performance CRC Generation", IEEE Transactions on Computers 57 (2008).
constexpr std::size_t kSlice = 8;

/// Remainder of each byte with 0 ... 7 bytes of zeros behind it.
using Tables = std::array<std::array<std::uint16_t, 256>, kSlice>;

constexpr Tables make_tables() {
  Tables tables{};
  for (unsigned byte = 0; byte < 256; ++byte) {
    unsigned crc = byte << 8U;
    for (std::size_t bit = 0; bit < 8 * kSlice; ++bit) {
      crc = (crc << 1U ^ ((crc & 0x8000U) != 0 ? 0x1021U : 0U)) & 0xFFFFU;
      if (bit % 8 == 7) tables[bit / 8][byte] = static_cast<std::uint16_t>(crc);
    }
  }
  return tables;
}

constexpr Tables kTables = make_tables();

}  // namespace

std::uint16_t crc_16(std::span<const std::uint8_t> bytes) noexcept {
  std::uint16_t crc = 0xFFFF;
  for (; bytes.size() >= kSlice; bytes = bytes.subspan(kSlice)) {
    const auto high = static_cast<std::uint8_t>(crc >> 8U);
    const auto low = static_cast<std::uint8_t>(crc);
    crc = kTables[7][bytes[0] ^ high] ^ kTables[6][bytes[1] ^ low];
    for (std::size_t i = 2; i < kSlice; ++i) crc ^= kTables[kSlice - 1 - i][bytes[i]];
  }
  for (const std::uint8_t byte : bytes) {
    crc = static_cast<std::uint16_t>(crc << 8U ^ kTables[0][static_cast<std::uint8_t>(crc >> 8U) ^ byte]);
  }
  return crc;
}

}  // namespace dermis::bytes::devices
