// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "dermis/bytes/layouts/layout.hpp"

namespace dermis::bytes::layouts {

/// Computes a Checksum of 8 to 32 bits.
class ChecksumOf {
 public:
  ChecksumOf() = default;
  /// `bits`: 8, 16, 24 or 32.
  ChecksumOf(const Checksum& checksum, unsigned bits);

  [[nodiscard]] std::uint32_t operator()(std::span<const std::uint8_t> bytes) const noexcept;

 private:
  [[nodiscard]] std::uint32_t of(std::span<const std::uint8_t> bytes) const noexcept;
  [[nodiscard]] std::uint32_t crc(std::span<const std::uint8_t> bytes) const noexcept;
  [[nodiscard]] std::uint32_t reflected_crc(std::span<const std::uint8_t> bytes) const noexcept;

  Checksum checksum_{};
  unsigned bits_ = 8;
  std::uint32_t mask_ = 0xFF;
  std::array<std::uint32_t, 256> table_{};  ///< crc: remainder of each byte.
};

}  // namespace dermis::bytes::layouts
