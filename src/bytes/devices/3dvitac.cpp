// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// 3D-ViTac and Sensitronics (MatrixArray.ino): each row as "%u " for each value and CR LF, an empty line after the
// last.
#include "bytes/devices/decimal.hpp"
#include "bytes/devices/protocols.hpp"
#include "bytes/devices/row_decoder.hpp"
#include "bytes/devices/wire_values.hpp"

namespace dermis::bytes::devices {
namespace {

constexpr std::uint32_t kMaxValue = 65535;
constexpr std::ptrdiff_t kMaxDigits = 5;

ParsedLine parse(std::span<const std::uint8_t> line, std::span<float> values) {
  if (line.back() != '\n') return {};
  const std::uint8_t* at = line.data();
  if (*at == '\n' || (*at == '\r' && line.size() == 2)) return {LineKind::separator};
  std::size_t count = 0;
  while (digit(*at) <= 9) {
    const std::uint8_t* const first = at;
    const std::uint32_t value = read_digits(at);
    if (at - first > kMaxDigits || value > kMaxValue) return {};
    if (count < values.size()) values[count] = static_cast<float>(value);
    ++count;
    if (*at == ' ') ++at;
  }
  if (*at == '\r') ++at;
  return at == &line.back() ? ParsedLine{LineKind::row, count, 0.0, 0} : ParsedLine{};
}

class ThreeDViTacEncoder final : public Encoder {
 public:
  explicit ThreeDViTacEncoder(FrameShape shape) : shape_(shape) {}

  void encode(const RawFrame& frame, std::vector<std::uint8_t>& bytes) override {
    for (std::size_t row = 0; row < shape_.rows; ++row) {
      for (std::size_t col = 0; col < shape_.cols; ++col) {
        append_decimal(static_cast<std::uint32_t>(to_wire(frame.counts[row * shape_.cols + col], 0, kMaxValue)), bytes);
        bytes.push_back(' ');
      }
      bytes.insert(bytes.end(), {'\r', '\n'});
    }
    bytes.insert(bytes.end(), {'\r', '\n'});
  }

 private:
  FrameShape shape_;
};

}  // namespace

Result<std::unique_ptr<Decoder>> make_3dvitac_decoder(const ProtocolOptions& options) {
  constexpr RowSyntax kSyntax = {.parse = parse, .announced_shape = nullptr, .single_lines = SingleLines::never};
  return std::unique_ptr<Decoder>(std::make_unique<RowDecoder>(kSyntax, options.shape));
}

Result<std::unique_ptr<Encoder>> make_3dvitac_encoder(const ProtocolOptions& options) {
  return std::unique_ptr<Encoder>(std::make_unique<ThreeDViTacEncoder>(*options.shape));
}

}  // namespace dermis::bytes::devices
