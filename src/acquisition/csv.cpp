// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Numbers as text, as sketches for the Arduino print them: a line per row and a separator line between frames, or a
// line per frame. Values are divided by commas, semicolons, spaces or tabs.
#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "acquisition/decimal.hpp"
#include "acquisition/protocols.hpp"
#include "acquisition/row_decoder.hpp"
#include "acquisition/wire_values.hpp"
#include "dermis/core/array_description.hpp"

namespace dermis::acquisition {
namespace {

constexpr std::uint32_t kMaxValue = (1U << 24U) - 1;  // of the widest converters, and exact as float
constexpr std::ptrdiff_t kMaxDigits = 8;
constexpr std::ptrdiff_t kMaxDecimals = 8;
constexpr std::string_view kRule = "-----\r\n";

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
  if ((is_mark(*at) || is_blank(*at)) && digit(at[1]) <= 9) return at + 1;
  at = after_blanks(at);
  return is_mark(*at) ? after_blanks(at + 1) : at;
}

/// A line that does not begin with a number.
LineKind kind_without_numbers(std::span<const std::uint8_t> line) noexcept {
  const bool has_words =
      std::any_of(line.begin(), line.end(), [](std::uint8_t byte) { return is_letter(byte) || digit(byte) <= 9; });
  return has_words ? LineKind::text : LineKind::separator;
}

/// The digits behind a decimal point, as a value below 1.
std::optional<float> read_fraction(const std::uint8_t*& at) noexcept {
  static constexpr std::array<float, kMaxDecimals + 1> kUnit = {1,     1e-1F, 1e-2F, 1e-3F, 1e-4F,
                                                                1e-5F, 1e-6F, 1e-7F, 1e-8F};
  const std::uint8_t* const first = at;
  const std::uint32_t value = read_digits(at);
  if (at == first || at - first > kMaxDecimals) return std::nullopt;
  return static_cast<float>(value) * kUnit[static_cast<std::size_t>(at - first)];
}

bool read_value(const std::uint8_t*& at, float& value) noexcept {
  const std::uint8_t* const first = at;
  const std::uint32_t whole = read_digits(at);
  if (at == first || at - first > kMaxDigits || whole > kMaxValue) return false;
  value = static_cast<float>(whole);
  if (*at != '.') return true;
  const std::optional<float> decimals = read_fraction(++at);
  value += decimals.value_or(0.0F);
  return decimals.has_value();
}

ParsedLine parse(std::span<const std::uint8_t> line, std::span<float> values) {
  if (line.back() != '\n') return {};
  const std::uint8_t* at = after_blanks(line.data());
  if (digit(*at) > 9) return {kind_without_numbers(line)};
  std::size_t count = 0;
  while (true) {
    float value = 0.0F;
    if (!read_value(at, value)) return {};
    if (count < values.size()) values[count] = value;
    ++count;
    const std::uint8_t* const behind = std::exchange(at, after_divider(at));
    if (*at == '\r' || *at == '\n') break;
    if (at == behind) return {};
  }
  if (*at == '\r') ++at;
  return at == &line.back() ? ParsedLine{LineKind::row, count} : ParsedLine{};
}

/// "CFG,rows,cols".
std::optional<FrameShape> announced_shape(std::span<const std::uint8_t> line) {
  constexpr std::string_view kWord = "CFG";
  if (line.back() != '\n' || line.size() <= kWord.size() || !std::equal(kWord.begin(), kWord.end(), line.begin()))
    return std::nullopt;
  std::array<float, 2> numbers{};
  const std::uint8_t* const rest = after_divider(line.data() + kWord.size());
  const auto offset = static_cast<std::size_t>(rest - line.data());
  if (offset >= line.size() || digit(*rest) > 9) return std::nullopt;
  const ParsedLine parsed = parse(line.subspan(offset), numbers);
  const auto is_valid = [](float lines) { return lines >= 1 && lines <= kMaxLines && lines == std::floor(lines); };
  if (parsed.kind != LineKind::row || parsed.values != 2 || !is_valid(numbers[0]) || !is_valid(numbers[1])) {
    return std::nullopt;
  }
  return FrameShape{static_cast<std::size_t>(numbers[0]), static_cast<std::size_t>(numbers[1])};
}

class CsvEncoder final : public Encoder {
 public:
  explicit CsvEncoder(FrameShape shape) : shape_(shape) {}

  void encode(const RawFrame& frame, std::vector<std::uint8_t>& bytes) override {
    for (std::size_t row = 0; row < shape_.rows; ++row) {
      for (std::size_t col = 0; col < shape_.cols; ++col) {
        if (col > 0) bytes.push_back(',');
        append_decimal(static_cast<std::uint32_t>(to_wire(frame.counts[row * shape_.cols + col], 0, kMaxValue)), bytes);
      }
      bytes.insert(bytes.end(), {'\r', '\n'});
    }
    bytes.insert(bytes.end(), kRule.begin(), kRule.end());
  }

 private:
  FrameShape shape_;
};

}  // namespace

Result<std::unique_ptr<Decoder>> make_csv_decoder(const ProtocolOptions& options) {
  constexpr RowSyntax kSyntax = {
      .parse = parse, .announced_shape = announced_shape, .single_lines = SingleLines::of_square};
  return std::unique_ptr<Decoder>(std::make_unique<RowDecoder>(kSyntax, options.shape));
}

std::unique_ptr<Decoder> make_csv_decoder_of_any_line() {
  constexpr RowSyntax kSyntax = {
      .parse = parse, .announced_shape = announced_shape, .single_lines = SingleLines::of_any};
  return std::make_unique<RowDecoder>(kSyntax, std::nullopt);
}

Result<std::unique_ptr<Encoder>> make_csv_encoder(const ProtocolOptions& options) {
  return std::unique_ptr<Encoder>(std::make_unique<CsvEncoder>(*options.shape));
}

}  // namespace dermis::acquisition
