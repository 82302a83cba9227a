// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/layouts/checksum_of.hpp"

#include <functional>
#include <numeric>

namespace dermis::bytes::layouts {
namespace {

// Eight bytes at a time: a CRC is linear, so the remainders of the eight add up. Source: Kounavis, Berry, "Novel Table
// Lookup-Based Algorithms for High-Performance CRC Generation", IEEE Transactions on Computers 57 (2008).
constexpr std::size_t kSlice = 8;

std::uint32_t reversed(std::uint32_t value) {
  std::uint32_t result = 0;
  for (unsigned bit = 0; bit < 32; ++bit) result |= (value >> bit & 1U) << (31U - bit);
  return result;
}

}  // namespace

/// The register has 32 bits, of which those of a shorter CRC are the highest. That of a reflected one runs to the
/// right.
ChecksumOf::ChecksumOf(const Checksum& checksum, unsigned bits) : checksum_(checksum), unused_(32U - bits) {
  if (checksum.kind != Checksum::Kind::crc) return;
  initial_ = checksum.initial << unused_;
  if (checksum.is_reflected) initial_ = reversed(initial_);
  tables_.resize(kSlice);
  const std::uint32_t polynomial = checksum.polynomial << unused_;
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t remainder = (checksum.is_reflected ? reversed(byte) >> 24U : byte) << 24U;
    for (auto& table : tables_) {
      for (int bit = 0; bit < 8; ++bit) {
        remainder = remainder << 1U ^ ((remainder & 0x80000000U) != 0 ? polynomial : 0U);
      }
      table[byte] = checksum.is_reflected ? reversed(remainder) : remainder;
    }
  }
}

std::uint32_t ChecksumOf::operator()(std::span<const std::uint8_t> bytes) const noexcept {
  if (bytes.size() < checksum_.from) return 0;
  return result(add(initial_, bytes.subspan(checksum_.from)));
}

std::uint32_t ChecksumOf::add(std::uint32_t before, std::span<const std::uint8_t> bytes) const noexcept {
  switch (checksum_.kind) {
    case Checksum::Kind::sum: return std::accumulate(bytes.begin(), bytes.end(), before);
    case Checksum::Kind::exclusive_or: return std::accumulate(bytes.begin(), bytes.end(), before, std::bit_xor<>());
    case Checksum::Kind::crc: break;
  }
  return checksum_.is_reflected ? crc<true>(before, bytes) : crc<false>(before, bytes);
}

std::uint32_t ChecksumOf::result(std::uint32_t after) const noexcept {
  const bool is_left = checksum_.kind == Checksum::Kind::crc && !checksum_.is_reflected;
  const std::uint32_t plain = (is_left ? after >> unused_ : after) ^ checksum_.final_xor;
  return (checksum_.is_negated ? 0U - plain : plain) & UINT32_MAX >> unused_;
}

template <bool IsReflected>
std::uint32_t ChecksumOf::crc(std::uint32_t crc, std::span<const std::uint8_t> bytes) const noexcept {
  constexpr auto kByteOf = [](std::uint32_t crc, unsigned k) { return crc >> 8U * (IsReflected ? k : 3U - k) & 0xFFU; };
  for (; bytes.size() >= kSlice; bytes = bytes.subspan(kSlice)) {
    std::uint32_t sum = 0;
    for (unsigned k = 0; k < 4; ++k) sum ^= tables_[kSlice - 1 - k][bytes[k] ^ kByteOf(crc, k)];
    for (unsigned k = 4; k < kSlice; ++k) sum ^= tables_[kSlice - 1 - k][bytes[k]];
    crc = sum;
  }
  for (const std::uint8_t byte : bytes) {
    crc = (IsReflected ? crc >> 8U : crc << 8U) ^ tables_[0][byte ^ kByteOf(crc, 0)];
  }
  return crc;
}

}  // namespace dermis::bytes::layouts
