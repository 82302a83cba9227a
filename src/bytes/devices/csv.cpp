// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Numbers as text, as sketches for the Arduino print them: a line per row and a separator line between frames, or a
// line per frame. Values are divided by commas, semicolons, spaces or tabs. A time may be the first of a line.
#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "bytes/devices/protocols.hpp"
#include "bytes/devices/row_decoder.hpp"
#include "bytes/devices/text_encoder.hpp"
#include "dermis/bytes/files/numbers.hpp"
#include "dermis/touch/frames/array_description.hpp"

namespace dermis::bytes::devices {
namespace {

constexpr std::ptrdiff_t kMaxDigits = 8;
constexpr std::ptrdiff_t kMaxClockDigits = 15;

constexpr bool is_blank(std::uint8_t byte) noexcept {
  return byte == ' ' || byte == '\t';
}

constexpr bool is_letter(std::uint8_t byte) noexcept {
  return (byte | 0x20) >= 'a' && (byte | 0x20) <= 'z';
}

const std::uint8_t* after_blanks(const std::uint8_t* at) noexcept {
  while (is_blank(*at)) ++at;
  return at;
}

/// Past what divides two values: blanks, one comma or semicolon, blanks.
const std::uint8_t* after_divider(const std::uint8_t* at) noexcept {
  const auto is_mark = [](std::uint8_t byte) { return byte == ',' || byte == ';'; };
  if ((is_mark(*at) || is_blank(*at)) && files::digit(at[1]) <= 9) return at + 1;
  at = after_blanks(at);
  return is_mark(*at) ? after_blanks(at + 1) : at;
}

/// A line that does not begin with a number.
LineKind kind_without_numbers(std::span<const std::uint8_t> line) noexcept {
  const bool has_words = std::any_of(line.begin(), line.end(),
                                     [](std::uint8_t byte) { return is_letter(byte) || files::digit(byte) <= 9; });
  return has_words ? LineKind::text : LineKind::separator;
}

/// A reading, or the time that the first number of a line may be.
bool read_value(const std::uint8_t*& at, bool is_first, double& value) noexcept {
  if (is_first) return files::take_decimal(at, kMaxClockDigits, value);
  return files::take_decimal(at, kMaxDigits, value) && std::floor(value) <= kMaxTextReading;
}

ParsedLine parse(std::span<const std::uint8_t> line, std::span<float> values) {
  if (line.back() != '\n') return {};
  const std::uint8_t* at = after_blanks(line.data());
  if (files::digit(*at) > 9) return {kind_without_numbers(line)};
  ParsedLine row{LineKind::row};
  while (true) {
    double value = 0.0;
    if (!read_value(at, row.values == 0, value)) return {};
    if (row.values == 0) row.first = value;
    if (row.values < values.size()) values[row.values] = static_cast<float>(value);
    ++row.values;
    const std::uint8_t* const behind = std::exchange(at, after_divider(at));
    if (*at == '\r' || *at == '\n') break;
    if (at == behind) return {};
  }
  if (*at == '\r') ++at;
  return at == &line.back() ? row : ParsedLine{};
}

/// "CFG,rows,cols".
std::optional<FrameShape> announced_shape(std::span<const std::uint8_t> line) {
  constexpr std::string_view kWord = "CFG";
  if (line.back() != '\n' || line.size() <= kWord.size() || !std::equal(kWord.begin(), kWord.end(), line.begin()))
    return std::nullopt;
  std::array<float, 2> numbers{};
  const std::uint8_t* const rest = after_divider(line.data() + kWord.size());
  const auto offset = static_cast<std::size_t>(rest - line.data());
  if (offset >= line.size() || files::digit(*rest) > 9) return std::nullopt;
  const ParsedLine parsed = parse(line.subspan(offset), numbers);
  const auto is_valid = [](float lines) { return lines >= 1 && lines <= kMaxLines && lines == std::floor(lines); };
  if (parsed.kind != LineKind::row || parsed.values != 2 || !is_valid(numbers[0]) || !is_valid(numbers[1])) {
    return std::nullopt;
  }
  return FrameShape{static_cast<std::size_t>(numbers[0]), static_cast<std::size_t>(numbers[1])};
}

}  // namespace

std::unique_ptr<Decoder> make_csv_decoder(const ProtocolOptions& options, bool any_size) {
  const RowSyntax syntax = {
      .parse = parse, .announced_shape = announced_shape, .single_lines = SingleLines::allowed, .any_size = any_size};
  return std::make_unique<RowDecoder>(syntax, options.shape);
}

Result<std::unique_ptr<Encoder>> make_csv_encoder(const ProtocolOptions& options) {
  return make_text_encoder({.between = ",", .row_end = "\r\n", .frame_end = "-----\r\n"}, options);
}

}  // namespace dermis::bytes::devices
