// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "dermis/bytes/files/text.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>

namespace dermis::bytes::files {
namespace {

constexpr std::int64_t kNanosPerSecond = 1'000'000'000;
constexpr double kMaxSeconds = 9e9;
constexpr std::string_view kHexadecimal = "0123456789ABCDEF";

/// digits[.digits], with at most ten and nine digits.
bool parse_plain_decimal(std::string_view text, std::int64_t& nanos) {
  const std::size_t dot = std::min(text.find('.'), text.size());
  const std::string_view whole = text.substr(0, dot);
  const std::string_view fraction = text.substr(std::min(dot + 1, text.size()));
  if (whole.empty() || whole.size() > 10 || fraction.size() > 9) return false;
  if (!std::all_of(whole.begin(), whole.end(), is_digit)) return false;
  if (!std::all_of(fraction.begin(), fraction.end(), is_digit)) return false;
  nanos = 0;
  for (const char c : whole) nanos = nanos * 10 + (c - '0');
  if (nanos > static_cast<std::int64_t>(kMaxSeconds)) return false;
  for (std::size_t i = 0; i < 9; ++i) nanos = nanos * 10 + (i < fraction.size() ? fraction[i] - '0' : 0);
  return true;
}

template <typename Number>
void append_shortest(std::string& text, Number value) {
  if (std::isnan(value)) {
    text += "nan";
    return;
  }
  std::array<char, 32> digits{};
  const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  text.append(digits.data(), end);
}

}  // namespace

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kMaxShown = 200;
  return "'" + std::string(text.substr(0, kMaxShown)) + (text.size() > kMaxShown ? "...'" : "'");
}

std::string quoted_toml(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      result += {'\\', c};
    } else if (c == '\t') {
      result += "\\t";
    } else if (c == '\r') {
      result += "\\r";
    } else if (byte < 0x20 || byte == 0x7F) {
      result.append("\\u00").append({kHexadecimal[byte >> 4U], kHexadecimal[byte & 15U]});
    } else {
      result += c;
    }
  }
  return result + '"';
}

std::string bytes_toml(std::string_view bytes) {
  const auto is_text = [](char c) { return (c >= ' ' && c <= '~') || c == '\n' || c == '\r'; };
  if (std::ranges::all_of(bytes, is_text)) return quoted_toml(bytes);
  std::string list = "[";
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    list.append(list.size() > 1 ? ", 0x" : "0x").append({kHexadecimal[byte >> 4U], kHexadecimal[byte & 15U]});
  }
  return list + "]";
}

std::string latin_1_bytes(std::string_view utf8) {
  std::string bytes;
  for (std::size_t i = 0; i < utf8.size(); ++i) {
    const auto byte = static_cast<unsigned char>(utf8[i]);
    const bool is_latin = (byte == 0xC2 || byte == 0xC3) && i + 1 < utf8.size();
    bytes +=
        is_latin ? static_cast<char>((byte & 3U) << 6U | (static_cast<unsigned char>(utf8[++i]) & 0x3FU)) : utf8[i];
  }
  return bytes;
}

std::string_view trimmed(std::string_view text) noexcept {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::string in_lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return lower;
}

bool parse_seconds(std::string_view text, Nanos& time) {
  const bool is_negative = text.starts_with('-');
  std::int64_t nanos = 0;
  if (parse_plain_decimal(text.substr(is_negative ? 1 : 0), nanos)) {
    time = Nanos(is_negative ? -nanos : nanos);
    return true;
  }
  double seconds = 0.0;
  if (!parse_number(text, seconds)) return false;
  const std::optional<Nanos> rounded = nanos_from_seconds(seconds);
  time = rounded.value_or(time);
  return rounded.has_value();
}

std::optional<Nanos> nanos_from_seconds(double seconds) {
  if (!(std::abs(seconds) <= kMaxSeconds)) return std::nullopt;
  // The product would be rounded to the doubles of its size: 256 ns apart since 1970.
  const double whole = std::floor(seconds);
  return Nanos(static_cast<std::int64_t>(whole) * kNanosPerSecond +
               std::llround((seconds - whole) * static_cast<double>(kNanosPerSecond)));
}

double seconds_of(Nanos time) {
  const auto micros = std::chrono::floor<std::chrono::microseconds>(time);
  if (micros == time) return static_cast<double>(micros.count()) / 1e6;
  const auto whole = std::chrono::floor<std::chrono::seconds>(time);
  return static_cast<double>(whole.count()) + 1e-9 * static_cast<double>((time - whole).count());
}

void append_number(std::string& text, float value) {
  append_shortest(text, value);
}

void append_number(std::string& text, double value) {
  append_shortest(text, value);
}

void append_seconds(std::string& text, Nanos time) {
  const std::int64_t nanos = time.count();
  if (nanos < 0) text += '-';
  text += std::to_string(std::abs(nanos / kNanosPerSecond));
  const std::int64_t fraction = std::abs(nanos % kNanosPerSecond);
  if (fraction == 0) return;
  const std::string digits = std::to_string(fraction + kNanosPerSecond).substr(1);
  text += '.';
  text += digits.substr(0, digits.find_last_not_of('0') + 1);
}

}  // namespace dermis::bytes::files
