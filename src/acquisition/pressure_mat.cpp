// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// The mat of willowec/pressure-mat (GUI/modules/communicator.py, mat_handler.py; board_code/src/board_v2/main.c): 56
// rows of 28 bytes, then FF FE FE FF. It waits for one request, then goes on for ever and listens no more.
#include <array>

#include "acquisition/mark_chain_decoder.hpp"
#include "acquisition/protocols.hpp"
#include "acquisition/wire_values.hpp"

namespace dermis::acquisition {
namespace {

constexpr FrameShape kShape = {56, 28};
constexpr std::size_t kTaxels = 1568;
constexpr std::array<std::uint8_t, 4> kTrailer = {0xFF, 0xFE, 0xFE, 0xFF};
constexpr std::string_view kRequest = "start_reading\n";

class PressureMatDecoder final : public MarkChainDecoder {
 public:
  PressureMatDecoder() : MarkChainDecoder(kTrailer, MarkAt::end, {kTaxels + kTrailer.size()}) {}

  [[nodiscard]] std::optional<FrameShape> shape() const noexcept override { return kShape; }
  [[nodiscard]] std::string_view request() const noexcept override { return is_sending_ ? "" : kRequest; }

 private:
  void read(std::span<const std::uint8_t> payload, RawFrame& frame) override {
    frame.counts.assign(payload.begin(), payload.end());
    is_sending_ = true;
  }

  void begin_again() override {
    MarkChainDecoder::begin_again();
    is_sending_ = false;
  }

  bool is_sending_ = false;
};

class PressureMatEncoder final : public Encoder {
 public:
  void encode(const RawFrame& frame, std::vector<std::uint8_t>& bytes) override {
    for (const float count : frame.counts) bytes.push_back(static_cast<std::uint8_t>(to_wire(count, 0, 255)));
    bytes.insert(bytes.end(), kTrailer.begin(), kTrailer.end());
    is_sending_ = true;
  }

  [[nodiscard]] std::string_view request() const noexcept override { return is_sending_ ? "" : kRequest; }

 private:
  bool is_sending_ = false;
};

}  // namespace

Result<std::unique_ptr<Decoder>> make_pressure_mat_decoder(const ProtocolOptions&) {
  return std::unique_ptr<Decoder>(std::make_unique<PressureMatDecoder>());
}

Result<std::unique_ptr<Encoder>> make_pressure_mat_encoder(const ProtocolOptions&) {
  return std::unique_ptr<Encoder>(std::make_unique<PressureMatEncoder>());
}

}  // namespace dermis::acquisition
