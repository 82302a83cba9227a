// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <libdeflate.h>

#include <array>
#include <cstdint>
#include <cstring>

namespace {

constexpr std::size_t kSteps = 8;  // bytes at once

using Table = std::array<std::uint32_t, 256>;

/// [k][byte]: the checksum of the byte and k zeros behind it.
constexpr std::array<Table, kSteps> make_tables() {
  constexpr std::uint32_t kPolynomial = 0xEDB88320U;
  std::array<Table, kSteps> tables{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t crc = byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1U) ^ ((crc & 1U) != 0 ? kPolynomial : 0);
    tables[0][byte] = crc;
  }
  for (std::size_t k = 1; k < kSteps; ++k) {
    for (std::size_t byte = 0; byte < 256; ++byte) {
      const std::uint32_t before = tables[k - 1][byte];
      tables[k][byte] = (before >> 8U) ^ tables[0][before & 0xFFU];
    }
  }
  return tables;
}

constexpr std::array<Table, kSteps> kTables = make_tables();

std::uint32_t eight_bytes(std::uint32_t crc, const std::uint8_t* bytes) {
  std::uint64_t word = 0;
  std::memcpy(&word, bytes, kSteps);
  word ^= crc;
  std::uint32_t result = 0;
  for (std::size_t k = 0; k < kSteps; ++k) result ^= kTables[kSteps - 1 - k][(word >> 8U * k) & 0xFFU];
  return result;
}

}  // namespace

std::uint32_t libdeflate_crc32(std::uint32_t crc, const void* data, std::size_t size) {
  const auto* bytes = static_cast<const std::uint8_t*>(data);
  crc = ~crc;
  for (; size >= kSteps; size -= kSteps, bytes += kSteps) crc = eight_bytes(crc, bytes);
  for (; size > 0; --size, ++bytes) crc = (crc >> 8U) ^ kTables[0][(crc ^ *bytes) & 0xFFU];
  return ~crc;
}
