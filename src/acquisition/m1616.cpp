// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// M1616, a 16x16 mat of mail-order shops: AA AB AC, 256 readings of 16 bits, big-endian, then 4 bytes of unknown
// meaning. Publications on it leave open whether its packet of 516 bytes counts the header. It is 519 bytes in all, or
// 516 with one byte after the readings. The distance between headers shows which.
#include <array>

#include "acquisition/mark_chain_decoder.hpp"
#include "acquisition/protocols.hpp"
#include "acquisition/wire_values.hpp"

namespace dermis::acquisition {
namespace {

constexpr FrameShape kShape = {16, 16};
constexpr std::array<std::uint8_t, 3> kHeader = {0xAA, 0xAB, 0xAC};
constexpr std::size_t kTrailerSize = 4;
constexpr std::size_t kPacketSize = 512 + kTrailerSize;

class M1616Decoder final : public MarkChainDecoder {
 public:
  M1616Decoder() : MarkChainDecoder(kHeader, MarkAt::begin, {kHeader.size() + kPacketSize, kPacketSize}) {}

  [[nodiscard]] std::optional<FrameShape> shape() const noexcept override { return kShape; }

 private:
  void read(std::span<const std::uint8_t> payload, RawFrame& frame) override {
    frame.counts.resize(kShape.taxel_count());
    for (std::size_t i = 0; i < frame.counts.size(); ++i) frame.counts[i] = read_big_16(&payload[2 * i]);
  }
};

class M1616Encoder final : public Encoder {
 public:
  void encode(const RawFrame& frame, std::vector<std::uint8_t>& bytes) override {
    bytes.insert(bytes.end(), kHeader.begin(), kHeader.end());
    for (const float count : frame.counts) append_big_16(static_cast<std::uint16_t>(to_wire(count, 0, 65535)), bytes);
    bytes.insert(bytes.end(), kTrailerSize, 0);
  }
};

}  // namespace

Result<std::unique_ptr<Decoder>> make_m1616_decoder(const ProtocolOptions&) {
  return std::unique_ptr<Decoder>(std::make_unique<M1616Decoder>());
}

Result<std::unique_ptr<Encoder>> make_m1616_encoder(const ProtocolOptions&) {
  return std::unique_ptr<Encoder>(std::make_unique<M1616Encoder>());
}

}  // namespace dermis::acquisition
