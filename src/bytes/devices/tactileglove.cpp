// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Bielefeld TactileGlove (linux/libio/SerialInput.cpp): five bytes for each taxel: 0x3C + index, 0x01, channel of the
// converter and the four high bits, the eight low bits, 0x00. A frame ends at the last index.
#include <algorithm>

#include "bytes/devices/protocols.hpp"
#include "bytes/devices/wire_values.hpp"
#include "dermis/bytes/layouts/window_decoder.hpp"

namespace dermis::bytes::devices {
namespace {

using layouts::Verdict;
using layouts::WindowDecoder;

constexpr std::uint8_t kFirstIndex = 0x3C;
constexpr std::size_t kMaxTaxels = 256 - kFirstIndex;
constexpr std::size_t kTaxelSize = 5;

bool is_taxel(const std::uint8_t* bytes, std::size_t index) noexcept {
  return bytes[0] == kFirstIndex + index && bytes[1] == 0x01 && bytes[4] == 0x00;
}

/// Number of taxels of rising index, from index 0 on, at most kMaxTaxels; empty where the bytes end in them.
std::optional<std::size_t> run_length(std::span<const std::uint8_t> bytes) noexcept {
  for (std::size_t index = 0; index < kMaxTaxels; ++index) {
    if (bytes.size() < (index + 1) * kTaxelSize) return std::nullopt;
    if (!is_taxel(&bytes[index * kTaxelSize], index)) return index;
  }
  return kMaxTaxels;
}

class TactileGloveDecoder final : public WindowDecoder {
 public:
  explicit TactileGloveDecoder(const std::optional<FrameShape>& shape) : shape_(shape) {}

  [[nodiscard]] std::optional<FrameShape> shape() const noexcept override { return shape_; }

 private:
  Verdict judge(std::span<const std::uint8_t> bytes, bool ended, RawFrame& frame) override {
    if (bytes.front() != kFirstIndex) return before_next_frame(bytes);
    if (!shape_ && !learn(bytes, ended)) return {};
    next_look_ = 0;
    return shape_ ? read(bytes, ended, frame) : Verdict{Verdict::Kind::noise, 1};
  }

  static Verdict before_next_frame(std::span<const std::uint8_t> bytes) {
    const auto next = std::find(bytes.begin(), bytes.end(), kFirstIndex);
    return {Verdict::Kind::noise, static_cast<std::size_t>(next - bytes.begin())};
  }

  /// Two runs of the same length, one behind the other, and the begin of a third. False where more bytes are needed;
  /// else `shape_` is known, or the bytes do not begin with a frame.
  bool learn(std::span<const std::uint8_t> bytes, bool ended) {
    if (bytes.size() < next_look_ && !ended) return false;
    next_look_ =
        bytes.size() + bytes.size() / 4 + kTaxelSize;  // else each byte would be looked at with each that comes
    const std::optional<std::size_t> run = run_length(bytes);
    if (!run) return ended;
    if (*run == 0) return true;
    const std::size_t size = *run * kTaxelSize;
    for (std::size_t index = 0; index <= *run; ++index) {
      const std::size_t at = size + index * kTaxelSize;
      if (bytes.size() < at + kTaxelSize) return ended;
      if (!is_taxel(&bytes[at], index % *run)) return true;
    }
    shape_ = FrameShape{1, *run};
    return true;
  }

  Verdict read(std::span<const std::uint8_t> bytes, bool ended, RawFrame& frame) {
    const std::size_t taxels = shape_->taxel_count();
    if (bytes.size() < taxels * kTaxelSize && !ended) return {};
    frame.counts.resize(taxels);
    for (std::size_t index = 0; index < taxels; ++index) {
      if (bytes.size() < (index + 1) * kTaxelSize) return {};
      const std::uint8_t* const taxel = &bytes[index * kTaxelSize];
      if (!is_taxel(taxel, index)) return broken(index);
      frame.counts[index] = static_cast<float>((taxel[2] & 0x0F) << 8 | taxel[3]);
    }
    return {Verdict::Kind::frame, taxels * kTaxelSize};
  }

  /// The frame ends before `index`; a single byte that looks like a first index is none.
  static Verdict broken(std::size_t index) {
    return index == 0 ? Verdict{Verdict::Kind::noise, 1} : Verdict{Verdict::Kind::damaged, index * kTaxelSize};
  }

  std::optional<FrameShape> shape_;
  std::size_t next_look_ = 0;  ///< Bytes that must be there before learn() looks at them again.
};

class TactileGloveEncoder final : public Encoder {
 public:
  void encode(const RawFrame& frame, std::vector<std::uint8_t>& bytes) override {
    constexpr std::size_t kChannels = 16;
    for (std::size_t index = 0; index < frame.counts.size(); ++index) {
      const auto value = static_cast<unsigned>(to_wire(frame.counts[index], 0, 4095));
      const unsigned channel = index % kChannels;
      for (const unsigned byte :
           {static_cast<unsigned>(kFirstIndex + index), 1U, channel << 4U | value >> 8U, value & 0xFFU, 0U}) {
        bytes.push_back(static_cast<std::uint8_t>(byte));
      }
    }
  }
};

Status check(const ProtocolOptions& options) {
  if (!options.shape || options.shape->taxel_count() <= kMaxTaxels) return Done{};
  return bad_input("rows=" + std::to_string(options.shape->rows) + "&cols=" + std::to_string(options.shape->cols) +
                   ": protocol=tactileglove has at most " + std::to_string(kMaxTaxels) + " taxels");
}

}  // namespace

Result<std::unique_ptr<Decoder>> make_tactileglove_decoder(const ProtocolOptions& options) {
  if (const Status valid = check(options); !valid) return valid.error();
  return std::unique_ptr<Decoder>(std::make_unique<TactileGloveDecoder>(options.shape));
}

Result<std::unique_ptr<Encoder>> make_tactileglove_encoder(const ProtocolOptions& options) {
  if (const Status valid = check(options); !valid) return valid.error();
  return std::unique_ptr<Encoder>(std::make_unique<TactileGloveEncoder>());
}

}  // namespace dermis::bytes::devices
