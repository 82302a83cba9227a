// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// The protocol of dermis itself, docs/wire-protocol.md. Zeros end packets and are nowhere else, as packets are stuffed
// (Cheshire and Baker 1999, "Consistent Overhead Byte Stuffing").

#include <cmath>
#include <cstring>
#include <utility>

#include "bytes/devices/frame_numbers.hpp"
#include "bytes/devices/protocols.hpp"
#include "bytes/devices/wire_values.hpp"
#include "dermis/bytes/layouts/checksum_of.hpp"
#include "dermis/bytes/layouts/escapes.hpp"
#include "dermis/bytes/layouts/window_decoder.hpp"
#include "dermis/touch/frames/array_description.hpp"

namespace dermis::bytes::devices {
namespace {

using layouts::Verdict;
using layouts::WindowDecoder;

using Bytes = std::span<const std::uint8_t>;

constexpr std::uint8_t kVersion = 1;
constexpr std::uint8_t kHasTemperature = 1U << 0U;
constexpr std::uint8_t kHasSupply = 1U << 1U;
constexpr std::uint8_t kHasTime = 1U << 2U;
constexpr std::uint8_t kAllFlags = kHasTemperature | kHasSupply | kHasTime;
constexpr std::size_t kHeaderSize = 18;
constexpr std::size_t kCrcSize = 4;
constexpr std::size_t kMaxBlock = 254;  ///< Bytes without a zero that one code can announce.
constexpr unsigned kSequenceBits = 32;
constexpr std::uint32_t kMaxLost = 1'000'000;

std::uint32_t crc_of(Bytes bytes) {
  static const layouts::ChecksumOf kCrcOf(layouts::kCrc32, 32);
  return kCrcOf(bytes);
}

std::size_t packet_size(const FrameShape& shape) {
  return kHeaderSize + 2 * shape.taxel_count() + kCrcSize;
}

/// The longest that so many bytes can become by stuffing.
std::size_t max_stuffed(std::size_t size) {
  return size + size / kMaxBlock + 1;
}

class DermisDecoder final : public WindowDecoder {
 public:
  DermisDecoder(const std::optional<FrameShape>& shape, bool datagrams)
      : shape_(shape),
        max_size_(max_stuffed(packet_size(shape.value_or(FrameShape{kMaxLines, kMaxLines})))),
        numbers_(kSequenceBits, std::chrono::microseconds(1), kMaxLost, datagrams) {}

  [[nodiscard]] std::optional<FrameShape> shape() const noexcept override { return shape_; }

 private:
  Verdict judge(Bytes bytes, bool, RawFrame& frame) override {
    const Bytes rest = bytes.subspan(std::exchange(searched_, 0));
    const void* zero = rest.empty() ? nullptr : std::memchr(rest.data(), 0, rest.size());
    if (zero == nullptr) return without_end(bytes.size());
    const auto length = static_cast<std::size_t>(static_cast<const std::uint8_t*>(zero) - bytes.data());
    const bool was_too_long = std::exchange(is_too_long_, false);
    const bool is_first = !std::exchange(has_begun_, true);
    if (!was_too_long && length <= max_size_ && unpack(bytes.first(length))) {
      return {read(frame) ? Verdict::Kind::frame : Verdict::Kind::noise, length + 1};
    }
    const bool is_recognised = !is_first && (was_too_long || length > 0);
    return {is_recognised ? Verdict::Kind::damaged : Verdict::Kind::noise, length + 1};
  }

  void begin_again() override {
    searched_ = 0;
    has_begun_ = false;
    is_too_long_ = false;
  }

  Verdict without_end(std::size_t size) {
    is_too_long_ = is_too_long_ || size > max_size_;
    if (is_too_long_) return {Verdict::Kind::noise, size};
    searched_ = size;
    return {};
  }

  /// Into packet_; false where it is none.
  bool unpack(Bytes stuffed) {
    const std::optional<std::size_t> size = layouts::undo_cobs(stuffed, packet_);
    const Bytes packet = Bytes(packet_).first(size.value_or(0));
    if (packet.size() <= kHeaderSize + kCrcSize) return false;
    const std::size_t crc_at = packet.size() - kCrcSize;
    if (crc_of(packet.first(crc_at)) != read_little<std::uint32_t>(&packet[crc_at])) return false;
    if (packet[0] != kVersion || (packet[1] & ~kAllFlags) != 0) return false;
    const FrameShape shape = {read_little<std::uint16_t>(&packet[14]), read_little<std::uint16_t>(&packet[16])};
    if (shape.rows > kMaxLines || shape.cols > kMaxLines || packet_size(shape) != packet.size()) return false;
    if (shape_ && shape != *shape_) return false;
    shape_ = shape;
    return true;
  }

  /// False where the frame is late or doubled.
  bool read(RawFrame& frame) {
    if (!read_header(frame)) return false;
    frame.counts.resize(shape_->taxel_count());
    const std::uint8_t* counts = &packet_[kHeaderSize];
    for (std::size_t i = 0; i < frame.counts.size(); ++i) frame.counts[i] = read_little<std::uint16_t>(counts + 2 * i);
    return true;
  }

  bool read_header(RawFrame& frame) {
    const std::uint8_t flags = packet_[1];
    std::optional<std::uint32_t> time;
    if ((flags & kHasTime) != 0) time = read_little<std::uint32_t>(&packet_[6]);
    if (!numbers_.count(read_little<std::uint32_t>(&packet_[2]), time, frame.acquisition)) return false;
    const auto temperature = static_cast<std::int16_t>(read_little<std::uint16_t>(&packet_[10]));
    if ((flags & kHasTemperature) != 0) frame.temperature_celsius = temperature / 100.0;
    const auto supply = read_little<std::uint16_t>(&packet_[12]);
    if ((flags & kHasSupply) != 0 && supply > 0) frame.supply_v = supply / 1000.0;
    return true;
  }

  std::optional<FrameShape> shape_;
  std::size_t max_size_;
  std::size_t searched_ = 0;  ///< Bytes of the window that hold no zero.
  bool has_begun_ = false;    ///< A zero was seen: what comes is a whole packet, not the end of one.
  bool is_too_long_ = false;  ///< The incoming bytes are the end of a piece that is no packet.
  std::vector<std::uint8_t> packet_;
  FrameNumbers numbers_;
};

void stuff(Bytes packet, std::vector<std::uint8_t>& bytes) {
  std::size_t code_at = bytes.size();
  bytes.push_back(1);
  for (const std::uint8_t byte : packet) {
    if (bytes[code_at] == kMaxBlock + 1) {
      code_at = bytes.size();
      bytes.push_back(1);
    }
    if (byte == 0) {
      code_at = bytes.size();
      bytes.push_back(1);
    } else {
      bytes.push_back(byte);
      ++bytes[code_at];
    }
  }
}

class DermisEncoder final : public Encoder {
 public:
  explicit DermisEncoder(const FrameShape& shape) : shape_(shape) {}

  void encode(const RawFrame& frame, std::vector<std::uint8_t>& bytes) override {
    const std::optional<Nanos>& time = frame.acquisition.device_time;
    const auto flag = [](bool is_set, std::uint8_t bit) { return is_set ? bit : 0; };
    packet_.clear();
    packet_.push_back(kVersion);
    packet_.push_back(static_cast<std::uint8_t>(flag(frame.temperature_celsius.has_value(), kHasTemperature) |
                                                flag(frame.supply_v.has_value(), kHasSupply) |
                                                flag(time.has_value(), kHasTime)));
    sequence_ = frame.acquisition.sequence.value_or(sequence_ + 1);
    append_little(static_cast<std::uint32_t>(sequence_), packet_);
    const auto microseconds = std::chrono::floor<std::chrono::microseconds>(time.value_or(Nanos{})).count();
    append_little(static_cast<std::uint32_t>(microseconds), packet_);
    const std::int64_t temperature = to_wire(100.0 * frame.temperature_celsius.value_or(0.0), INT16_MIN, INT16_MAX);
    append_little(static_cast<std::uint16_t>(temperature), packet_);
    append_little(static_cast<std::uint16_t>(to_wire(1000.0 * frame.supply_v.value_or(0.0), 0, UINT16_MAX)), packet_);
    append_little(static_cast<std::uint16_t>(shape_.rows), packet_);
    append_little(static_cast<std::uint16_t>(shape_.cols), packet_);
    for (const float count : frame.counts) {
      append_little(static_cast<std::uint16_t>(to_wire(count, 0, UINT16_MAX)), packet_);
    }
    append_little(crc_of(packet_), packet_);
    stuff(packet_, bytes);
    bytes.push_back(0);
  }

 private:
  FrameShape shape_;
  std::vector<std::uint8_t> packet_;
  std::uint64_t sequence_ = UINT64_MAX;
};

}  // namespace

Result<std::unique_ptr<Decoder>> make_dermis_decoder(const ProtocolOptions& options) {
  return std::unique_ptr<Decoder>(std::make_unique<DermisDecoder>(options.shape, options.datagrams));
}

Result<std::unique_ptr<Encoder>> make_dermis_encoder(const ProtocolOptions& options) {
  return std::unique_ptr<Encoder>(std::make_unique<DermisEncoder>(*options.shape));
}

}  // namespace dermis::bytes::devices
