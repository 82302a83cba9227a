// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors

// WiReSens (WiSensToolkit.cpp, GenericReceiver.py), little-endian packets of as many readings each: sender, 1 byte;
// index of the first reading, 2; readings, 2 each; packet number, 4. On serial lines "wr" follows, which is not
// escaped. Packets follow each other through frame after frame and may straddle their borders. The number counts the
// packets that were built; those that the device expects the receiver to predict are not sent.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "bytes/devices/protocols.hpp"
#include "bytes/devices/wire_values.hpp"
#include "bytes/devices/wiresens_packets.hpp"
#include "dermis/bytes/layouts/byte_window.hpp"

namespace dermis::bytes::devices {
namespace {

constexpr std::size_t kMaxTaxels = 65536;
constexpr std::size_t kMaxNodesPerPacket = 32767;
/// Packets in a row that have to fit together where the stream begins anew. It is one less where they continue after
/// skipped bytes, and only one behind a delimiter.
constexpr std::size_t kChain = 3;
class WireSensDecoder final : public Decoder {
 public:
  WireSensDecoder(FrameShape shape, const PacketFormat& format)
      : shape_(shape), format_(format), held_(format.taxels, std::numeric_limits<float>::quiet_NaN()) {}

  void push(std::span<const std::uint8_t> bytes) override {
    if (ended_) end_stream();
    window_.push(bytes);
  }

  bool next(RawFrame& frame) override {
    while (const std::optional<Packet> packet = find_packet()) {
      const bool whole = !continues(*packet)            ? begin_anew(*packet)
                         : packet->reads_nodes(format_) ? read_pairs(*packet, frame)
                         : is_of_later_frame(*packet)   ? close_frame(*packet, frame)
                                                        : read_readings(*packet, frame);
      if (whole) return true;
    }
    if (ended_) end_stream();
    return false;
  }

  void finish() override { ended_ = true; }
  [[nodiscard]] std::uint64_t frame_end() const noexcept override { return frame_end_; }
  [[nodiscard]] std::optional<FrameShape> shape() const noexcept override { return shape_; }
  [[nodiscard]] const DecoderCounts& counts() const noexcept override { return counts_; }

 private:
  [[nodiscard]] bool continues(const Packet& packet) const noexcept {
    return last_ && follows(*last_, packet, format_);
  }
  /// The number of `packet`, counted on where it wraps.
  [[nodiscard]] std::int64_t full_number(const Packet& packet) const noexcept {
    return number_ + (packet.number - last_->number);
  }
  /// The number of the frame in which `packet` begins, -1 where it began before packet 0.
  [[nodiscard]] std::int64_t frame_of(std::int64_t number, std::size_t start) const noexcept {
    const auto taxels = static_cast<std::int64_t>(format_.taxels);
    const auto nodes = static_cast<std::int64_t>(format_.nodes);
    return (number * nodes - static_cast<std::int64_t>(start) + taxels) / taxels - 1;
  }
  [[nodiscard]] bool is_of_later_frame(const Packet& packet) const noexcept {
    return frame_of(full_number(packet), packet.start) > open_.number;
  }

  /// The frame that is being read.
  struct OpenFrame {
    std::int64_t number = 0;
    std::size_t received = 0;      // its readings so far
    std::size_t bytes = 0;         // of the packets that began in it
    bool seen_from_start = false;  // the packet with its first reading was not before the stream
    bool damaged = false;          // a packet of it was damaged
  };

  std::optional<Packet> find_packet();
  [[nodiscard]] bool chain_begins(std::size_t packets, bool& undecided) const;
  bool begin_anew(const Packet& packet);
  void note_damage(const Packet& packet);
  bool read_readings(const Packet& packet, RawFrame& frame);
  bool read_pairs(const Packet& packet, RawFrame& frame);
  bool close_frame(const Packet& packet, RawFrame& frame);
  void consume(const Packet& packet);
  bool deliver(RawFrame& frame);
  void drop_frame();
  void end_stream();

  FrameShape shape_;
  PacketFormat format_;
  layouts::ByteWindow window_;
  DecoderCounts counts_;
  std::uint64_t frame_end_ = 0;
  bool ended_ = false;

  std::optional<Packet> last_;          // packet taken before
  std::int64_t number_ = 0;             // of that packet, counted on where it wraps
  std::uint64_t packet_end_ = 0;        // position in the stream
  bool skipped_ = false;                // bytes were skipped behind it
  std::array<std::uint8_t, 2> tail_{};  // the last two of them

  std::vector<float> held_;  // last reading of each taxel
  OpenFrame open_;
  std::uint32_t lost_before_ = 0;
};

/// The packet at the front of the window, once it is sure to be one.
std::optional<Packet> WireSensDecoder::find_packet() {
  while (window_.bytes().size() >= format_.size()) {
    const std::optional<Packet> packet = packet_at(window_.bytes().data(), format_);
    const bool expected = packet && continues(*packet);
    if (expected && (!skipped_ || (format_.delimited && tail_ == kDelimiter))) return packet;
    bool undecided = false;
    if (packet && chain_begins(expected ? kChain - 1 : kChain, undecided)) return packet;
    if (undecided) return std::nullopt;
    tail_ = {tail_[1], window_.bytes().front()};
    window_.drop(1);
    ++counts_.skipped_bytes;
    skipped_ = true;
  }
  return std::nullopt;
}

bool WireSensDecoder::chain_begins(std::size_t packets, bool& undecided) const {
  const std::span<const std::uint8_t> bytes = window_.bytes();
  std::optional<Packet> before;
  for (std::size_t i = 0; i < packets; ++i) {
    if (bytes.size() < (i + 1) * format_.size()) {
      undecided = !ended_;
      return ended_ && (i > 1 || format_.delimited);
    }
    const std::optional<Packet> packet = packet_at(&bytes[i * format_.size()], format_);
    if (!packet || (before && !follows(*before, *packet, format_))) return false;
    before = packet;
  }
  return true;
}

/// The device or the reading of it started here, or packets for more than kMaxGap frames are missing.
bool WireSensDecoder::begin_anew(const Packet& packet) {
  drop_frame();
  last_ = Packet{packet.start, packet.number - 1};
  number_ = static_cast<std::int64_t>(packet.number) - 1;
  if (!packet.reads_nodes(format_)) {
    last_->start = (packet.start + format_.taxels - format_.nodes % format_.taxels) % format_.taxels;
    open_.number = frame_of(number_ + 1, packet.start);
    open_.seen_from_start = packet.start == 0;
  }
  skipped_ = false;
  return false;
}

/// Packets are missing before `packet`, and bytes were skipped: what is missing was not left out by the device.
void WireSensDecoder::note_damage(const Packet& packet) {
  if (skipped_ && packet.number - last_->number > 1) open_.damaged = true;
}

bool WireSensDecoder::read_readings(const Packet& packet, RawFrame& frame) {
  if (packet.start > 0) note_damage(packet);
  const std::uint8_t* const readings = window_.bytes().data() + kReadings;
  const std::size_t first = std::min(format_.nodes, format_.taxels - packet.start);
  for (std::size_t i = 0; i < first; ++i) {
    held_[packet.start + i] = static_cast<float>(read_little<std::uint16_t>(readings + 2 * i));
  }
  open_.received += first;
  consume(packet);
  const bool ends = packet.start + first == format_.taxels;
  const bool whole = ends && deliver(frame);
  for (std::size_t i = first; i < format_.nodes; ++i) {
    held_[i - first] = static_cast<float>(read_little<std::uint16_t>(readings + 2 * i));
  }
  if (ends) open_.received = format_.nodes - first;
  return whole;
}

/// Each packet is a frame.
bool WireSensDecoder::read_pairs(const Packet& packet, RawFrame& frame) {
  const std::uint8_t* const pairs = window_.bytes().data() + kReadings;
  const std::size_t count = format_.nodes / 2;
  const auto index = [&](std::size_t pair) { return read_little<std::uint16_t>(pairs + 4 * pair); };
  const auto value = [&](std::size_t pair) { return read_little<std::uint16_t>(pairs + 4 * pair + 2); };
  const std::uint32_t step = packet.number - last_->number;
  bool valid = true;
  for (std::size_t pair = 0; pair < count; ++pair) valid = valid && index(pair) < format_.taxels;
  for (std::size_t pair = 0; valid && pair < count; ++pair)
    held_[index(pair)] = std::numeric_limits<float>::quiet_NaN();
  open_.received = 0;
  for (std::size_t pair = 0; valid && pair < count; ++pair) {
    open_.received += std::isnan(held_[index(pair)]) ? 1 : 0;  // a node may come more than once
    held_[index(pair)] = value(pair);
  }
  open_.number = full_number(packet);
  open_.seen_from_start = true;
  lost_before_ += step - 1;
  open_.damaged = !valid;
  consume(packet);
  return deliver(frame);
}

/// `packet`, which is not taken yet, is of a later frame: those behind the last packet of this one were not sent.
bool WireSensDecoder::close_frame(const Packet& packet, RawFrame& frame) {
  if (open_.received > 0) {
    note_damage(packet);
    return deliver(frame);
  }
  const std::int64_t missing = frame_of(full_number(packet), packet.start) - open_.number;
  lost_before_ += static_cast<std::uint32_t>(missing);
  open_.number += missing;
  return false;
}

void WireSensDecoder::consume(const Packet& packet) {
  number_ = full_number(packet);
  last_ = packet;
  skipped_ = false;
  open_.bytes += format_.size();
  window_.drop(format_.size());
  packet_end_ = window_.position();
}

/// The frame that is being read is over. Taxels without a reading in it keep the one before.
bool WireSensDecoder::deliver(RawFrame& frame) {
  const bool whole = open_.seen_from_start && !open_.damaged;
  if (whole) {
    frame.temperature_celsius.reset();
    frame.supply_v.reset();
    frame.acquisition = {};
    frame.acquisition.sequence = static_cast<std::uint64_t>(open_.number);
    frame.acquisition.lost_before = std::exchange(lost_before_, 0);
    frame.acquisition.held_taxels = static_cast<std::uint32_t>(format_.taxels - open_.received);
    frame.counts.assign(held_.begin(), held_.end());
    counts_.lost_frames += frame.acquisition.lost_before;
    ++counts_.frames;
    frame_end_ = packet_end_;
    open_.bytes = 0;
  }
  drop_frame();
  ++open_.number;
  open_.seen_from_start = true;
  return whole;
}

void WireSensDecoder::drop_frame() {
  if (open_.damaged) ++counts_.damaged_frames;
  counts_.skipped_bytes += open_.bytes;
  open_.bytes = open_.received = 0;
  open_.damaged = false;
}

void WireSensDecoder::end_stream() {
  ended_ = false;
  counts_.skipped_bytes += window_.bytes().size();
  window_.drop(window_.bytes().size());
  drop_frame();
  last_.reset();
}

class WireSensEncoder final : public Encoder {
 public:
  explicit WireSensEncoder(const PacketFormat& format) : format_(format) {}

  void encode(const RawFrame& frame, std::vector<std::uint8_t>& bytes) override {
    for (const float count : frame.counts) {
      readings_.push_back(static_cast<std::uint16_t>(to_wire(count, 0, 65535)));
      if (readings_.size() == format_.nodes) append_packet(bytes);
    }
  }

  /// The device would fill its packet with readings of the next frame; here the last one stands for them.
  void finish(std::vector<std::uint8_t>& bytes) override {
    if (readings_.empty()) return;
    readings_.resize(format_.nodes, readings_.back());
    append_packet(bytes);
  }

 private:
  void append_packet(std::vector<std::uint8_t>& bytes) {
    bytes.push_back(0);
    append_little(static_cast<std::uint16_t>(start_), bytes);
    for (const std::uint16_t reading : readings_) append_little(reading, bytes);
    append_little(number_++, bytes);
    if (format_.delimited) bytes.insert(bytes.end(), kDelimiter.begin(), kDelimiter.end());
    start_ = (start_ + format_.nodes) % format_.taxels;
    readings_.clear();
  }

  PacketFormat format_;
  std::size_t start_ = 0;
  std::uint32_t number_ = 0;
  std::vector<std::uint16_t> readings_;  // of the packet that is being filled
};

Result<PacketFormat> packet_format(const ProtocolOptions& options) {
  if (!options.shape) {
    return bad_input("protocol=wiresens: packets do not tell the size of a frame; give rows and cols");
  }
  const std::size_t taxels = options.shape->taxel_count();
  if (taxels > kMaxTaxels) {
    return bad_input("rows=" + std::to_string(options.shape->rows) + "&cols=" + std::to_string(options.shape->cols) +
                     ": protocol=wiresens has at most " + std::to_string(kMaxTaxels) + " taxels");
  }
  if (options.nodes_per_packet < 1 || options.nodes_per_packet > kMaxNodesPerPacket) {
    return bad_input("nodes_per_packet=" + std::to_string(options.nodes_per_packet) + ": must be 1 ... " +
                     std::to_string(kMaxNodesPerPacket));
  }
  return PacketFormat{taxels, std::min(options.nodes_per_packet, taxels), options.delimited};
}

}  // namespace

Result<std::unique_ptr<Decoder>> make_wiresens_decoder(const ProtocolOptions& options) {
  const Result<PacketFormat> format = packet_format(options);
  if (!format) return format.error();
  return std::unique_ptr<Decoder>(std::make_unique<WireSensDecoder>(*options.shape, *format));
}

Result<std::unique_ptr<Encoder>> make_wiresens_encoder(const ProtocolOptions& options) {
  const Result<PacketFormat> format = packet_format(options);
  if (!format) return format.error();
  return std::unique_ptr<Encoder>(std::make_unique<WireSensEncoder>(*format));
}

}  // namespace dermis::bytes::devices
