// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "dermis/bytes/files/numbers.hpp"
#include "dermis/touch/frames/frames.hpp"

namespace dermis::bytes::files {

/// Some programs begin UTF-8 with it.
inline constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// 'text' in quotes for a message; long text is cut.
[[nodiscard]] std::string in_quotes(std::string_view text);

/// As a string of TOML, in quotes and with escapes.
[[nodiscard]] std::string quoted_toml(std::string_view text);

/// Bytes as a text of TOML where they are printable or end a line, or else as a list: [0xAA, 0x01].
[[nodiscard]] std::string bytes_toml(std::string_view bytes);

/// Characters U+0080 to U+00FF of UTF-8 become one byte each; others stay.
[[nodiscard]] std::string latin_1_bytes(std::string_view utf8);

/// Space, tab, carriage return or form feed.
[[nodiscard]] constexpr bool is_blank(char c) noexcept {
  return c == ' ' || c == '\t' || c == '\r' || c == '\f';
}

/// The text without the blanks at both ends.
[[nodiscard]] std::string_view trimmed(std::string_view text) noexcept;

/// ASCII letters become small ones.
[[nodiscard]] std::string in_lower_case(std::string_view text);

/// Seconds of at most 9e9 in size (285 years), rounded to nanoseconds; plain decimals are exact.
[[nodiscard]] bool parse_seconds(std::string_view text, Nanos& time);

/// Rounded to nanoseconds; empty for NaN, or more than 9e9 in size.
[[nodiscard]] std::optional<Nanos> nanos_from_seconds(double seconds);

/// Time in seconds: the nearest double if it is a whole number of microseconds.
[[nodiscard]] double seconds_of(Nanos time);

/// The fewest digits that read back as the same number; "nan" for every NaN.
void append_number(std::string& text, float value);
void append_number(std::string& text, double value);

/// Exact seconds without trailing zeros.
void append_seconds(std::string& text, Nanos time);

}  // namespace dermis::bytes::files
