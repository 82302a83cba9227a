// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/layouts/checksum_of.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "bytes/layouts/stream_checksum.hpp"
#include "dermis/touch/frames/random.hpp"

namespace dermis::bytes::layouts {
namespace {

std::uint32_t reversed(std::uint32_t value, unsigned bits) {
  std::uint32_t result = 0;
  for (unsigned bit = 0; bit < bits; ++bit) result |= (value >> bit & 1U) << (bits - 1 - bit);
  return result;
}

/// A CRC bit by bit, as its parameters define it.
std::uint32_t crc_of(const Checksum& checksum, unsigned bits, std::span<const std::uint8_t> bytes) {
  std::uint64_t crc = checksum.initial;
  for (const std::uint8_t byte : bytes) {
    crc ^= std::uint64_t{checksum.is_reflected ? reversed(byte, 8) : byte} << (bits - 8);
    for (int bit = 0; bit < 8; ++bit) crc = crc << 1U ^ ((crc >> (bits - 1) & 1U) != 0 ? checksum.polynomial : 0U);
    crc &= UINT32_MAX >> (32U - bits);
  }
  const auto remainder = static_cast<std::uint32_t>(crc);
  return (checksum.is_reflected ? reversed(remainder, bits) : remainder) ^ checksum.final_xor;
}

TEST(ChecksumOf, is_the_remainder_of_any_bytes) {
  Random random(1);
  for (const unsigned bits : {8U, 16U, 24U, 32U}) {
    for (const bool is_reflected : {false, true}) {
      const auto any = [&] { return static_cast<std::uint32_t>(random.bits()) >> (32U - bits); };
      const Checksum checksum = {Checksum::Kind::crc, 0, any() | 1U, any(), any(), is_reflected};
      const ChecksumOf computed(checksum, bits);
      for (std::size_t size = 0; size < 40; ++size) {
        std::vector<std::uint8_t> bytes(size);
        for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random.bits());
        EXPECT_EQ(computed(bytes), crc_of(checksum, bits, bytes)) << bits << " bits of " << size << " bytes";
      }
    }
  }
}

TEST(StreamChecksum, of_any_part_is_that_of_its_bytes) {
  Random random(2);
  std::vector<std::uint8_t> stream(3000);
  for (std::uint8_t& byte : stream) byte = static_cast<std::uint8_t>(random.bits());
  for (const auto kind : {Checksum::Kind::sum, Checksum::Kind::exclusive_or, Checksum::Kind::crc}) {
    for (const unsigned bits : {8U, 16U, 24U, 32U}) {
      for (const bool is_reflected : {false, true}) {
        const auto any = [&] { return static_cast<std::uint32_t>(random.bits()) >> (32U - bits); };
        const Checksum checksum = {kind, random.below(3), any(), any(), any(), is_reflected, random.below(2) == 1};
        const ChecksumOf expected(checksum, bits);
        StreamChecksum of_stream(checksum, bits);
        for (std::size_t at = 0; at < stream.size(); at += random.below(random.below(4) == 0 ? 600 : 3)) {
          const std::size_t size = random.below(std::min<std::uint64_t>(stream.size() - at, 500)) + 1;
          const std::span<const std::uint8_t> part = std::span(stream).subspan(at, size);
          ASSERT_EQ(of_stream(part, at), expected(part)) << size << " bytes from " << at << " on, " << bits << " bits";
        }
      }
    }
  }
}

TEST(ChecksumOf, leaves_out_the_first_bytes) {
  const std::array<std::uint8_t, 4> bytes = {1, 2, 3, 4};
  EXPECT_EQ(ChecksumOf({.from = 2}, 8)(bytes), 7U);
  EXPECT_EQ(ChecksumOf({.from = 2, .is_negated = true}, 8)(bytes), 249U);
  EXPECT_EQ(ChecksumOf({.from = 5}, 8)(bytes), 0U);
}

}  // namespace
}  // namespace dermis::bytes::layouts
