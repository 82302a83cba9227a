// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

/// Integers as they stand on the wire.
namespace dermis::bytes::devices {

template <std::unsigned_integral T>
[[nodiscard]] constexpr T read_little(const std::uint8_t* bytes) noexcept {
  T value = 0;
  for (std::size_t i = 0; i < sizeof(T); ++i) value = static_cast<T>(value | static_cast<T>(bytes[i]) << (8 * i));
  return value;
}

[[nodiscard]] constexpr std::uint16_t read_big_16(const std::uint8_t* bytes) noexcept {
  return static_cast<std::uint16_t>(bytes[0] << 8 | bytes[1]);
}

template <std::unsigned_integral T>
void append_little(T value, std::vector<std::uint8_t>& bytes) {
  for (std::size_t i = 0; i < sizeof(T); ++i) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

inline void append_big_16(std::uint16_t value, std::vector<std::uint8_t>& bytes) {
  bytes.push_back(static_cast<std::uint8_t>(value >> 8));
  bytes.push_back(static_cast<std::uint8_t>(value));
}

/// The whole number in low ... high nearest to `value`; `low` for one that is not a number.
[[nodiscard]] inline std::int64_t to_wire(double value, std::int64_t low, std::int64_t high) noexcept {
  if (!(value > static_cast<double>(low))) return low;
  return value >= static_cast<double>(high) ? high : std::llround(value);
}

}  // namespace dermis::bytes::devices
