// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/layouts/checksums.hpp"

#include <functional>
#include <numeric>

namespace dermis::bytes::layouts {
namespace {

std::uint32_t reversed(std::uint32_t value, unsigned bits) {
  std::uint32_t result = 0;
  for (unsigned bit = 0; bit < bits; ++bit) result |= (value >> bit & 1U) << (bits - 1 - bit);
  return result;
}

/// Remainder of a byte; the register of a reflected CRC runs to the right.
std::uint32_t remainder_of(std::uint32_t byte, const Checksum& checksum, unsigned bits) {
  if (checksum.is_reflected) {
    const std::uint32_t polynomial = reversed(checksum.polynomial, bits);
    for (int bit = 0; bit < 8; ++bit) byte = byte >> 1U ^ ((byte & 1U) != 0 ? polynomial : 0U);
    return byte;
  }
  const std::uint32_t highest = 1U << (bits - 1);
  std::uint32_t remainder = byte << (bits - 8);
  for (int bit = 0; bit < 8; ++bit) {
    remainder = remainder << 1U ^ ((remainder & highest) != 0 ? checksum.polynomial : 0U);
  }
  return remainder;
}

}  // namespace

ChecksumOf::ChecksumOf(const Checksum& checksum, unsigned bits)
    : checksum_(checksum), bits_(bits), mask_(UINT32_MAX >> (32U - bits)) {
  if (checksum.kind != Checksum::Kind::crc) return;
  for (std::uint32_t byte = 0; byte < table_.size(); ++byte) table_[byte] = remainder_of(byte, checksum, bits) & mask_;
}

std::uint32_t ChecksumOf::operator()(std::span<const std::uint8_t> bytes) const noexcept {
  if (bytes.size() < checksum_.from) return 0;
  const std::uint32_t plain = of(bytes.subspan(checksum_.from)) ^ checksum_.final_xor;
  return (checksum_.is_negated ? 0U - plain : plain) & mask_;
}

std::uint32_t ChecksumOf::of(std::span<const std::uint8_t> bytes) const noexcept {
  switch (checksum_.kind) {
    case Checksum::Kind::sum: return std::accumulate(bytes.begin(), bytes.end(), std::uint32_t{0});
    case Checksum::Kind::exclusive_or: return std::accumulate(bytes.begin(), bytes.end(), 0U, std::bit_xor<>());
    case Checksum::Kind::crc: break;
  }
  return checksum_.is_reflected ? reflected_crc(bytes) : crc(bytes);
}

std::uint32_t ChecksumOf::crc(std::span<const std::uint8_t> bytes) const noexcept {
  std::uint32_t crc = checksum_.initial;
  for (const std::uint8_t byte : bytes) {
    crc = (bits_ == 8 ? 0U : crc << 8U & mask_) ^ table_[(crc >> (bits_ - 8) ^ byte) & 0xFFU];
  }
  return crc;
}

std::uint32_t ChecksumOf::reflected_crc(std::span<const std::uint8_t> bytes) const noexcept {
  std::uint32_t crc = reversed(checksum_.initial, bits_);
  for (const std::uint8_t byte : bytes) crc = crc >> 8U ^ table_[(crc ^ byte) & 0xFFU];
  return crc;
}

}  // namespace dermis::bytes::layouts
