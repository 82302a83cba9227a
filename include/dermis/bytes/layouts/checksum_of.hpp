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

  /// The same in parts: the register before the first byte, after some more, and the checksum that it means.
  [[nodiscard]] std::uint32_t first_register() const noexcept { return initial_; }
  [[nodiscard]] std::uint32_t add(std::uint32_t before, std::span<const std::uint8_t> bytes) const noexcept;
  [[nodiscard]] std::uint32_t result(std::uint32_t after) const noexcept;
  [[nodiscard]] const Checksum& checksum() const noexcept { return checksum_; }

 private:
  template <bool IsReflected>
  [[nodiscard]] std::uint32_t crc(std::uint32_t crc, std::span<const std::uint8_t> bytes) const noexcept;

  Checksum checksum_{};
  unsigned unused_ = 24;                                ///< Bits of 32.
  std::uint32_t initial_ = 0;                           ///< Of the register.
  std::vector<std::array<std::uint32_t, 256>> tables_;  ///< crc: remainder of a byte before 0 ... 7 others.
};

}  // namespace dermis::bytes::layouts
