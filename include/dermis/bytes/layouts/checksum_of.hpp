// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

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
  template <bool IsReflected>
  [[nodiscard]] std::uint32_t crc(std::span<const std::uint8_t> bytes) const noexcept;

  Checksum checksum_{};
  unsigned unused_ = 24;                                ///< Bits of 32.
  std::uint32_t initial_ = 0;                           ///< Of the register.
  std::vector<std::array<std::uint32_t, 256>> tables_;  ///< crc: remainder of a byte before 0 ... 7 others.
};

}  // namespace dermis::bytes::layouts
