// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// FlexiTac (PyFlexiTac, flexitac/protocol.py): AA 55, then one byte a taxel, row-major; AA 55 among them is not
// escaped.
#include <array>

#include "acquisition/mark_chain_decoder.hpp"
#include "acquisition/protocols.hpp"
#include "acquisition/wire_values.hpp"

namespace dermis::acquisition {
namespace {

constexpr std::array<std::uint8_t, 2> kHeader = {0xAA, 0x55};

/// Arrays that are built; their sizes differ, so that the size of the frames determines the shape.
constexpr std::array<FrameShape, 4> kKnownShapes = {{{16, 32}, {12, 32}, {16, 16}, {32, 32}}};

std::size_t frame_size_of(const FrameShape& shape) {
  return kHeader.size() + shape.taxel_count();
}

std::vector<std::size_t> possible_sizes(const std::optional<FrameShape>& shape) {
  if (shape) return {frame_size_of(*shape)};
  std::vector<std::size_t> sizes;
  for (const FrameShape& known : kKnownShapes) sizes.push_back(frame_size_of(known));
  return sizes;
}

class FlexitacDecoder final : public MarkChainDecoder {
 public:
  explicit FlexitacDecoder(const std::optional<FrameShape>& shape)
      : MarkChainDecoder(kHeader, MarkAt::begin, possible_sizes(shape)), given_shape_(shape) {}

  [[nodiscard]] std::optional<FrameShape> shape() const noexcept override {
    if (given_shape_ || !frame_size()) return given_shape_;
    for (const FrameShape& known : kKnownShapes) {
      if (frame_size_of(known) == *frame_size()) return known;
    }
    return std::nullopt;
  }

 private:
  void read(std::span<const std::uint8_t> payload, RawFrame& frame) override {
    frame.counts.assign(payload.begin(), payload.end());
  }

  std::optional<FrameShape> given_shape_;
};

class FlexitacEncoder final : public Encoder {
 public:
  void encode(const RawFrame& frame, std::vector<std::uint8_t>& bytes) override {
    bytes.insert(bytes.end(), kHeader.begin(), kHeader.end());
    for (const float count : frame.counts) bytes.push_back(static_cast<std::uint8_t>(to_wire(count, 0, 255)));
  }
};

}  // namespace

Result<std::unique_ptr<Decoder>> make_flexitac_decoder(const ProtocolOptions& options) {
  return std::unique_ptr<Decoder>(std::make_unique<FlexitacDecoder>(options.shape));
}

Result<std::unique_ptr<Encoder>> make_flexitac_encoder(const ProtocolOptions&) {
  return std::unique_ptr<Encoder>(std::make_unique<FlexitacEncoder>());
}

}  // namespace dermis::acquisition
