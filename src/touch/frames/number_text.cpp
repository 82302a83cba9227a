// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/touch/frames/number_text.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <limits>

namespace dermis {
namespace {

constexpr std::size_t kMostCharacters = std::numeric_limits<double>::max_exponent10 + 8;  // with sign, point and tenths

template <typename... Format>
std::string text_of(Format... format) {
  std::array<char, kMostCharacters> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), format...).ptr};
}

}  // namespace

std::string significant_digits(double value, int digits) {
  return text_of(value, std::chars_format::general, digits);
}

std::string tenths(double value) {
  return text_of(value, std::chars_format::fixed, 1);
}

std::string shortest_text(float value) {
  constexpr float kMostWhole = 16777216.0F;  // 2^24: beyond it, not every digit of a whole number tells something
  constexpr float kMostPlain = 1e16F;
  const float size = std::abs(value);
  const bool is_plain = size == 0.0F || (size >= 1e-4F && size < kMostPlain);
  if (is_plain && size < kMostWhole) return text_of(value, std::chars_format::fixed);
  std::string text = text_of(value, std::chars_format::scientific);
  if (!is_plain) return text;
  const std::size_t end = text.find('e');
  const auto digits = static_cast<std::size_t>(10 * (text[end + 2] - '0') + text[end + 3] - '0') + 1;
  text.erase(end);
  std::erase(text, '.');
  text.resize(digits + (std::signbit(value) ? 1 : 0), '0');
  return text;
}

}  // namespace dermis
