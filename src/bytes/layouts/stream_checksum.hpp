// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "dermis/bytes/layouts/checksum_of.hpp"

namespace dermis::bytes::layouts {

/// The checksum of parts of a stream. Looks at no byte more than twice, however the parts overlap.
class StreamChecksum {
 public:
  StreamChecksum() = default;
  /// `bits`: 8, 16, 24 or 32.
  StreamChecksum(const Checksum& checksum, unsigned bits) : checksum_(checksum, bits) {}

  /// The checksum of `bytes`, which stand at `position` in the stream. Positions never fall.
  [[nodiscard]] std::uint32_t operator()(std::span<const std::uint8_t> bytes, std::uint64_t position);

 private:
  using ByteTables = std::array<std::array<std::uint32_t, 256>, 4>;  ///< [bytes of the register]

  [[nodiscard]] std::uint32_t of_seen(std::span<const std::uint8_t> bytes, std::uint64_t position);
  void look_at(std::span<const std::uint8_t> bytes, std::uint64_t position);
  [[nodiscard]] std::uint32_t after_zeros(std::uint32_t before, std::size_t count);
  void add_power();

  ChecksumOf checksum_;
  std::uint64_t seen_end_ = 0;            ///< The end of the parts so far.
  std::uint64_t begin_ = 0;               ///< The first byte whose register is known.
  std::vector<std::uint32_t> registers_;  ///< Before each byte from there on, and behind the last.
  std::vector<ByteTables> powers_;        ///< A register after 1, 2, 4, 8 ... bytes of 0.
};

}  // namespace dermis::bytes::layouts
