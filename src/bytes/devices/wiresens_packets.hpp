// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>

#include "bytes/devices/wire_values.hpp"
#include "dermis/bytes/devices/protocol.hpp"

/// Packets of WiReSens as they stand on the wire.
namespace dermis::bytes::devices {

constexpr std::size_t kReadings = 3;           // offset of the first reading
constexpr std::size_t kHeaderAndNumber = 7;    // bytes of a packet besides its readings
constexpr std::size_t kReadNodeStart = 20000;  // instead of an index: the readings are pairs of index and value
constexpr std::array<std::uint8_t, 2> kDelimiter = {'w', 'r'};

/// Frames' worth of packets that may be missing between two that fit together.
constexpr std::size_t kMaxGap = 64;

struct PacketFormat {
  std::size_t taxels = 0;
  std::size_t nodes = 0;  // readings in a packet
  bool delimited = true;

  [[nodiscard]] std::size_t number_offset() const noexcept { return kReadings + 2 * nodes; }
  [[nodiscard]] std::size_t size() const noexcept {
    return kHeaderAndNumber + 2 * nodes + (delimited ? kDelimiter.size() : 0);
  }
  [[nodiscard]] std::uint32_t max_gap() const noexcept {
    return static_cast<std::uint32_t>(kMaxGap * (taxels + nodes - 1) / nodes);
  }
};

struct Packet {
  std::size_t start = 0;
  std::uint32_t number = 0;

  [[nodiscard]] bool reads_nodes(const PacketFormat& format) const noexcept {
    return start == kReadNodeStart && format.taxels <= kReadNodeStart;
  }
};

/// The packet at `bytes`; empty where none can be.
inline std::optional<Packet> packet_at(const std::uint8_t* bytes, const PacketFormat& format) noexcept {
  const Packet packet = {read_little<std::uint16_t>(bytes + 1),
                         read_little<std::uint32_t>(bytes + format.number_offset())};
  if (packet.start >= format.taxels && !packet.reads_nodes(format)) return std::nullopt;
  if (format.delimited &&
      std::memcmp(bytes + format.size() - kDelimiter.size(), kDelimiter.data(), kDelimiter.size()) != 0) {
    return std::nullopt;
  }
  return packet;
}

/// `packet` comes behind `before`, perhaps with others between that were not sent or were lost.
inline bool follows(const Packet& before, const Packet& packet, const PacketFormat& format) noexcept {
  const std::uint32_t step = packet.number - before.number;
  if (step == 0 || step > format.max_gap()) return false;
  if (before.reads_nodes(format) || packet.reads_nodes(format)) return before.start == packet.start;
  return (before.start + step * format.nodes) % format.taxels == packet.start;
}

/// Learns from packets their number of readings, their delimiters and the number of taxels. That number must be that of
/// `known.shape`, or else a square or `any_size`: as one row then. Empty where the bytes are no such packets.
[[nodiscard]] std::optional<ProtocolOptions> learn_wiresens(std::span<const std::uint8_t> bytes,
                                                            const ProtocolOptions& known, bool any_size);

}  // namespace dermis::bytes::devices
