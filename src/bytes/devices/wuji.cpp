// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// Wuji tactile glove (wujihandcpp, data/tactile.hpp), all little-endian:
//   3088 bytes: AA 55, u16 3088, u8 hand, 3 unused, 768 x f32 at 8 (0 ... 1, NaN where invalid),
//               u16 number at 3080, u32 milliseconds at 3082, u16 CRC at 3086
//   1550 bytes: AA 55, u16 1550, u8 hand, 1 unused, 768 x i16 at 6, u16 number at 1542, u32 milliseconds at 1544,
//               u16 CRC at 1548
// CRC-16-CCITT over the bytes from 2 to before the CRC. The range of the CRC of the long form is not published: the
// same is taken.
#include <algorithm>
#include <array>
#include <bit>

#include "bytes/devices/crc_16.hpp"
#include "bytes/devices/frame_numbers.hpp"
#include "bytes/devices/protocols.hpp"
#include "bytes/devices/wire_values.hpp"
#include "dermis/bytes/layouts/window_decoder.hpp"

namespace dermis::bytes::devices {
namespace {

using layouts::Verdict;
using layouts::WindowDecoder;

constexpr FrameShape kShape = {24, 32};
constexpr std::size_t kTaxels = 768;
constexpr std::array<std::uint8_t, 2> kMarker = {0xAA, 0x55};
constexpr std::size_t kHeaderSize = 4;
constexpr std::size_t kNumberSize = 2;
constexpr std::size_t kTimeSize = 4;
constexpr std::size_t kCrcSize = 2;
constexpr unsigned kSequenceBits = 16;
constexpr std::uint32_t kMaxLost = 32767;

enum class Form : std::uint16_t { floats = 3088, integers = 1550 };

constexpr std::size_t size_of(Form form) {
  return static_cast<std::size_t>(form);
}

constexpr std::size_t readings_at(Form form) {
  return form == Form::floats ? 8 : 6;
}

/// The bytes of a frame that its CRC covers.
std::span<const std::uint8_t> covered(std::span<const std::uint8_t> frame) {
  return frame.subspan(kMarker.size(), frame.size() - kMarker.size() - kCrcSize);
}

class WujiDecoder final : public WindowDecoder {
 public:
  explicit WujiDecoder(bool datagrams) : numbers_(kSequenceBits, std::chrono::milliseconds(1), kMaxLost, datagrams) {}

  [[nodiscard]] std::optional<FrameShape> shape() const noexcept override { return kShape; }

 private:
  Verdict judge(std::span<const std::uint8_t> bytes, bool ended, RawFrame& frame) override {
    const auto marker = std::find(bytes.begin(), bytes.end(), kMarker[0]);
    if (marker != bytes.begin()) return {Verdict::Kind::noise, static_cast<std::size_t>(marker - bytes.begin())};
    if (bytes.size() < kHeaderSize) return {};
    const auto form = static_cast<Form>(read_little<std::uint16_t>(&bytes[2]));
    if (bytes[1] != kMarker[1] || (form != Form::floats && form != Form::integers)) return {Verdict::Kind::noise, 1};
    if (bytes.size() < size_of(form)) return ended ? Verdict{Verdict::Kind::noise, 1} : Verdict{};
    const std::span<const std::uint8_t> whole = bytes.first(size_of(form));
    if (crc_16(covered(whole)) != read_little<std::uint16_t>(&whole[whole.size() - kCrcSize])) {
      return {Verdict::Kind::damaged, kHeaderSize};  // the next frame may begin inside it
    }
    return {read(whole, form, frame) ? Verdict::Kind::frame : Verdict::Kind::noise, whole.size()};
  }

  /// False where the frame is late or doubled.
  bool read(std::span<const std::uint8_t> bytes, Form form, RawFrame& frame) {
    const std::uint8_t* number = &bytes[bytes.size() - kCrcSize - kTimeSize - kNumberSize];
    const auto time = read_little<std::uint32_t>(number + kNumberSize);
    if (!numbers_.count(read_little<std::uint16_t>(number), time, frame.acquisition)) return false;
    frame.counts.resize(kTaxels);
    const std::uint8_t* readings = &bytes[readings_at(form)];
    for (std::size_t i = 0; i < kTaxels; ++i) {
      frame.counts[i] =
          form == Form::floats
              ? std::bit_cast<float>(read_little<std::uint32_t>(&readings[4 * i]))
              : static_cast<float>(static_cast<std::int16_t>(read_little<std::uint16_t>(&readings[2 * i])));
    }
    return true;
  }

  FrameNumbers numbers_;
};

/// Frames with readings above 1 are sent as those devices do that send integers.
class WujiEncoder final : public Encoder {
 public:
  void encode(const RawFrame& frame, std::vector<std::uint8_t>& bytes) override {
    const bool has_integers = std::any_of(frame.counts.begin(), frame.counts.end(), [](float c) { return c > 1.0F; });
    const Form form = has_integers ? Form::integers : Form::floats;
    const std::size_t begin = bytes.size();
    bytes.insert(bytes.end(), kMarker.begin(), kMarker.end());
    append_little(static_cast<std::uint16_t>(form), bytes);
    bytes.resize(begin + readings_at(form));
    for (const float count : frame.counts) {
      if (form == Form::floats) append_little(std::bit_cast<std::uint32_t>(count), bytes);
      if (form == Form::integers) append_little(static_cast<std::uint16_t>(to_wire(count, -32768, 32767)), bytes);
    }
    sequence_ = frame.acquisition.sequence.value_or(sequence_ + 1);
    append_little(static_cast<std::uint16_t>(sequence_), bytes);
    const auto time = std::chrono::floor<std::chrono::milliseconds>(frame.acquisition.device_time.value_or(frame.time));
    append_little(static_cast<std::uint32_t>(time.count()), bytes);
    append_little(std::uint16_t{0}, bytes);
    const std::span<std::uint8_t> whole = std::span(bytes).subspan(begin);
    const std::uint16_t crc = crc_16(covered(whole));
    whole[whole.size() - 2] = static_cast<std::uint8_t>(crc);
    whole[whole.size() - 1] = static_cast<std::uint8_t>(crc >> 8U);
  }

 private:
  std::uint64_t sequence_ = UINT64_MAX;
};

}  // namespace

Result<std::unique_ptr<Decoder>> make_wuji_decoder(const ProtocolOptions& options) {
  return std::unique_ptr<Decoder>(std::make_unique<WujiDecoder>(options.datagrams));
}

Result<std::unique_ptr<Encoder>> make_wuji_encoder(const ProtocolOptions&) {
  return std::unique_ptr<Encoder>(std::make_unique<WujiEncoder>());
}

}  // namespace dermis::bytes::devices
