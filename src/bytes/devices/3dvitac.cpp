// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// 3D-ViTac and Sensitronics (MatrixArray.ino): each row as "%u " for each value and CR LF, an empty line after the
// last.
#include "bytes/devices/protocols.hpp"
#include "bytes/devices/row_decoder.hpp"
#include "bytes/devices/text_encoder.hpp"
#include "dermis/bytes/files/numbers.hpp"

namespace dermis::bytes::devices {
namespace {

constexpr std::uint32_t kMaxValue = 65535;
constexpr std::ptrdiff_t kMaxDigits = 5;

ParsedLine parse(std::span<const std::uint8_t> line, std::span<float> values) {
  if (line.back() != '\n') return {};
  const std::uint8_t* at = line.data();
  if (*at == '\n' || (*at == '\r' && line.size() == 2)) return {LineKind::separator};
  std::size_t count = 0;
  while (files::digit(*at) <= 9) {
    const std::uint8_t* const first = at;
    const std::uint32_t value = files::take_digits(at);
    if (at - first > kMaxDigits || value > kMaxValue) return {};
    if (count < values.size()) values[count] = static_cast<float>(value);
    ++count;
    if (*at == ' ') ++at;
  }
  if (*at == '\r') ++at;
  return at == &line.back() ? ParsedLine{LineKind::row, count, 0.0, 0} : ParsedLine{};
}

}  // namespace

Result<std::unique_ptr<Decoder>> make_3dvitac_decoder(const ProtocolOptions& options) {
  constexpr RowSyntax kSyntax = {.parse = parse, .announced_shape = nullptr, .single_lines = SingleLines::never};
  return std::unique_ptr<Decoder>(std::make_unique<RowDecoder>(kSyntax, options.shape));
}

Result<std::unique_ptr<Encoder>> make_3dvitac_encoder(const ProtocolOptions& options) {
  return make_text_encoder({.between = " ", .row_end = " \r\n", .frame_end = "\r\n", .most = kMaxValue}, options);
}

}  // namespace dermis::bytes::devices
