// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// JSON lines: an object or an array a line, a frame each. The readings are the only array in it: of numbers, or of rows
// of numbers. Other members of an object may be numbers, words and objects, and are not read.
#include <cmath>
#include <string_view>

#include "bytes/devices/protocols.hpp"
#include "bytes/devices/row_decoder.hpp"
#include "bytes/devices/text_encoder.hpp"
#include "dermis/bytes/files/numbers.hpp"
#include "dermis/touch/frames/array_description.hpp"

namespace dermis::bytes::devices {
namespace {

constexpr std::ptrdiff_t kMaxDigits = 15;
constexpr int kDeepest = 8;  // objects in objects

/// One line on its way; `at_` never goes behind its '\n'.
class JsonLine {
 public:
  JsonLine(std::span<const std::uint8_t> line, std::span<float> values)
      : at_(line.data()), end_(&line.back()), values_(values) {}

  ParsedLine parse() {
    skip_blanks();
    if (*at_ != '{' && *at_ != '[') return {at_ == end_ ? LineKind::separator : LineKind::text};
    const bool is_whole = *at_ == '{' ? read_object(0) : read_readings();
    skip_blanks();
    if (!is_whole || at_ != end_ || row_.values == 0) return {};
    return row_;
  }

 private:
  void skip_blanks() {
    while (*at_ == ' ' || *at_ == '\t' || (*at_ == '\r' && at_ + 1 == end_)) ++at_;
  }

  bool take(std::uint8_t mark) {
    skip_blanks();
    if (*at_ != mark) return false;
    ++at_;
    return true;
  }

  bool read_object(int depth) {
    if (depth == kDeepest || !take('{')) return false;
    if (take('}')) return true;
    do {
      if (!skip_text() || !take(':') || !read_member(depth)) return false;
    } while (take(','));
    return take('}');
  }

  bool read_member(int depth) {
    skip_blanks();
    if (*at_ == '[') return row_.values == 0 && read_readings();
    if (*at_ == '{') return read_object(depth + 1);
    return *at_ == '"' ? skip_text() : skip_word();
  }

  bool skip_text() {
    if (!take('"')) return false;
    for (; at_ != end_ && *at_ != '"'; ++at_) {
      if (*at_ == '\\' && at_ + 1 != end_) ++at_;
    }
    return take('"');
  }

  /// A number, true, false or null.
  bool skip_word() {
    const std::uint8_t* const first = at_;
    const auto is_part = [](std::uint8_t byte) {
      return (byte >= 'a' && byte <= 'z') || files::digit(byte) <= 9 || byte == '-' || byte == '+' || byte == '.' ||
             byte == 'E';
    };
    while (is_part(*at_)) ++at_;
    return at_ != first;
  }

  bool read_readings() {
    if (!take('[')) return false;
    skip_blanks();
    if (*at_ != '[') return read_numbers() && take(']');
    do {
      const std::size_t before = row_.values;
      if (!take('[') || !read_numbers() || !take(']')) return false;
      const std::size_t cols = row_.values - before;
      if (row_.cols != 0 && row_.cols != cols) return false;
      row_.cols = cols;
    } while (take(','));
    return take(']');
  }

  bool read_numbers() {
    do {
      skip_blanks();
      double value = 0.0;
      if (!files::take_decimal(at_, kMaxDigits, value)) return false;
      if (row_.values > 0 && std::floor(value) > kMaxTextReading) return false;
      if (row_.values == 0) row_.first = value;
      if (row_.values < values_.size()) values_[row_.values] = static_cast<float>(value);
      ++row_.values;
    } while (take(','));
    return true;
  }

  const std::uint8_t* at_;
  const std::uint8_t* end_;
  std::span<float> values_;
  ParsedLine row_{LineKind::row};
};

ParsedLine parse(std::span<const std::uint8_t> line, std::span<float> values) {
  return line.back() == '\n' ? JsonLine(line, values).parse() : ParsedLine{};
}

}  // namespace

std::unique_ptr<Decoder> make_json_decoder(const ProtocolOptions& options, bool any_size) {
  const RowSyntax syntax = {
      .parse = parse, .announced_shape = nullptr, .single_lines = SingleLines::only, .any_size = any_size};
  return std::make_unique<RowDecoder>(syntax, options.shape);
}

Result<std::unique_ptr<Encoder>> make_json_encoder(const ProtocolOptions& options) {
  return make_text_encoder({.frame_begin = R"({"data":[)",
                            .row_begin = "[",
                            .between = ",",
                            .row_end = "]",
                            .between_rows = ",",
                            .frame_end = "]}\n"},
                           options);
}

}  // namespace dermis::bytes::devices
