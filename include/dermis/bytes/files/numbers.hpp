// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <type_traits>

/// Numbers as they stand in text. A file that accepts more, such as a decimal comma, makes it one of these.
namespace dermis::bytes::files {

/// 0 ... 9, or more where the byte is not a digit.
[[nodiscard]] constexpr std::uint32_t digit(std::uint8_t byte) noexcept {
  return static_cast<std::uint32_t>(byte) - '0';
}
[[nodiscard]] constexpr bool is_digit(char c) noexcept {
  return digit(static_cast<std::uint8_t>(c)) <= 9;
}

/// The number that the text begins with, with a sign '-' where its type has one. Others than whole ones may have a
/// point and an exponent, and be nan or inf. Returns its size; 0, and `value` stays, where there is none that the type
/// holds.
template <typename Number>
[[nodiscard]] std::size_t number_at(std::string_view text, Number& value) noexcept {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} ? static_cast<std::size_t>(end - text.data()) : 0;
}

/// The same of a whole number without a sign in hexadecimal digits, without 0x.
template <typename Number>
[[nodiscard]] std::size_t hexadecimal_at(std::string_view text, Number& value) noexcept {
  static_assert(std::is_unsigned_v<Number>);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, 16);
  return error == std::errc{} ? static_cast<std::size_t>(end - text.data()) : 0;
}

/// The whole text is a number.
template <typename Number>
[[nodiscard]] bool parse_number(std::string_view text, Number& value) noexcept {
  constexpr std::size_t kMostExact = 7;  // digits that a float holds: nearly all raw counts
  if (std::is_same_v<Number, float> && !text.empty() && text.size() <= kMostExact &&
      std::ranges::all_of(text, is_digit)) {
    int whole = 0;
    for (const char c : text) whole = whole * 10 + (c - '0');
    value = static_cast<Number>(whole);
    return true;
  }
  return !text.empty() && number_at(text, value) == text.size();
}

/// The whole text is a whole number in hexadecimal digits.
template <typename Number>
[[nodiscard]] bool parse_hexadecimal(std::string_view text, Number& value) noexcept {
  return !text.empty() && hexadecimal_at(text, value) == text.size();
}

/// The whole text as a number from `least` to `most`.
template <typename Number>
[[nodiscard]] std::optional<Number> number_within(std::string_view text, Number least, Number most) noexcept {
  Number value{};
  const bool is_one = parse_number(text, value) && value >= least && value <= most;
  return is_one ? std::optional(value) : std::nullopt;
}

/// The digits at `at`, which goes behind them; nothing of use where they are more than 9. Something else must follow.
[[nodiscard]] constexpr std::uint32_t take_digits(const std::uint8_t*& at) noexcept {
  std::uint32_t value = 0;
  for (std::uint32_t next = digit(*at); next <= 9; next = digit(*++at)) value = 10 * value + next;
  return value;
}

/// A number without sign or exponent, of at most `most_digits` before the point (15 or fewer are exact) and 8 behind
/// it. `at` goes behind it. False where there is none.
[[nodiscard]] inline bool take_decimal(const std::uint8_t*& at, std::ptrdiff_t most_digits, double& value) noexcept {
  static constexpr std::array<double, 9> kUnit = {1, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8};
  const std::uint8_t* const first = at;
  value = 0.0;
  for (; digit(*at) <= 9; ++at) value = 10.0 * value + digit(*at);
  if (at == first || at - first > most_digits) return false;
  if (*at != '.') return true;
  const std::uint8_t* const decimals = ++at;
  const std::uint32_t fraction = take_digits(at);
  const auto count = static_cast<std::size_t>(at - decimals);
  if (count == 0 || count >= kUnit.size()) return false;
  value += fraction * kUnit[count];
  return true;
}

}  // namespace dermis::bytes::files
