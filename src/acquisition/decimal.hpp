// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <array>
#include <charconv>
#include <cstdint>
#include <vector>

/// Numbers as they stand in text.
namespace dermis::acquisition {

/// 0 ... 9, or more where the byte is not a digit.
[[nodiscard]] constexpr std::uint32_t digit(std::uint8_t byte) noexcept {
  return static_cast<std::uint32_t>(byte) - '0';
}

/// The number at `at`, which goes behind its digits; nothing of use where they are more than 9.
[[nodiscard]] constexpr std::uint32_t read_digits(const std::uint8_t*& at) noexcept {
  std::uint32_t value = 0;
  for (std::uint32_t next = digit(*at); next <= 9; next = digit(*++at)) value = 10 * value + next;
  return value;
}

inline void append_decimal(std::uint32_t value, std::vector<std::uint8_t>& bytes) {
  std::array<char, 10> digits{};
  char* const end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  bytes.insert(bytes.end(), digits.data(), end);
}

}  // namespace dermis::acquisition
