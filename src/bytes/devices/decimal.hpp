// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <vector>

/// Numbers as they stand in text.
namespace dermis::bytes::devices {

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

/// A number without sign or exponent, of at most `most_digits` before the point (15 or fewer are exact) and 8 behind
/// it. `at` goes behind it. False where there is none.
inline bool read_decimal(const std::uint8_t*& at, std::ptrdiff_t most_digits, double& value) noexcept {
  static constexpr std::array<double, 9> kUnit = {1, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8};
  const std::uint8_t* const first = at;
  value = 0.0;
  for (; digit(*at) <= 9; ++at) value = 10.0 * value + digit(*at);
  if (at == first || at - first > most_digits) return false;
  if (*at != '.') return true;
  const std::uint8_t* const decimals = ++at;
  const std::uint32_t fraction = read_digits(at);
  const auto count = static_cast<std::size_t>(at - decimals);
  if (count == 0 || count >= kUnit.size()) return false;
  value += fraction * kUnit[count];
  return true;
}

inline void append_decimal(std::uint32_t value, std::vector<std::uint8_t>& bytes) {
  std::array<char, 10> digits{};
  char* const end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  bytes.insert(bytes.end(), digits.data(), end);
}

}  // namespace dermis::bytes::devices
