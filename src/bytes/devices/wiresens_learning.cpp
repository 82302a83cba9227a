// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <numeric>

#include "bytes/devices/square_shape.hpp"
#include "bytes/devices/wiresens_packets.hpp"

namespace dermis::bytes::devices {
namespace {

constexpr std::size_t kMostNodes = 120;       // the firmware's
constexpr std::size_t kReach = 2048;          // bytes in which the first packets must be
constexpr std::size_t kLargestFrame = 65536;  // as far as an index reaches
constexpr std::size_t kPackets = 12;          // that have to agree
constexpr std::size_t kLeaps = 3;             // of the index, back to the begin of a frame, among them
constexpr std::size_t kMostLeftOut = 1000;    // packets

/// Number of taxels, by the packets from `bytes` on; empty where they do not agree. Between two packets others may be
/// left out: the indices then tell a multiple of it, and it has to be seen from neighbours once.
std::optional<std::size_t> learn_taxels(std::span<const std::uint8_t> bytes, const PacketFormat& format) {
  std::size_t taxels = 0;  // the greatest number that all leaps of the index are multiples of
  std::size_t of_neighbours = 0;
  std::size_t leaps = 0;
  std::size_t packets = 1;
  std::optional<Packet> before = packet_at(bytes.data(), format);
  for (std::size_t at = format.size(); before && at + format.size() <= bytes.size(); at += format.size()) {
    const std::optional<Packet> packet = packet_at(&bytes[at], format);
    const std::size_t step = packet ? packet->number - before->number : 0;
    if (step == 0 || step > kMostLeftOut) break;
    const std::size_t expected = before->start + step * format.nodes;
    if (packet->start > expected) return std::nullopt;
    if (packet->start < expected) {
      taxels = std::gcd(taxels, expected - packet->start);
      if (step == 1) of_neighbours = expected - packet->start;
      ++leaps;
    }
    before = packet;
    ++packets;
  }
  const bool agree = packets >= kPackets && leaps >= kLeaps && taxels == of_neighbours && taxels >= format.nodes;
  return agree ? std::optional(taxels) : std::nullopt;
}

std::optional<std::size_t> find_taxels(std::span<const std::uint8_t> bytes, const PacketFormat& format) {
  const std::size_t size = format.size();
  for (std::size_t at = 0; at < kReach && at + 2 * size <= bytes.size(); ++at) {
    const std::uint8_t* const number = &bytes[at + format.number_offset()];
    if (static_cast<std::uint8_t>(number[size] - number[0]) != 1) continue;  // of most, which one look tells
    if (read_little<std::uint32_t>(number + size) - read_little<std::uint32_t>(number) != 1) continue;
    if (const std::optional<std::size_t> taxels = learn_taxels(bytes.subspan(at), format)) return taxels;
  }
  return std::nullopt;
}

std::optional<FrameShape> shape_of(std::size_t taxels, const ProtocolOptions& known, bool any_size) {
  if (known.shape) return known.shape->taxel_count() == taxels ? known.shape : std::nullopt;
  const std::optional<FrameShape> square = square_shape(taxels);
  return square || !any_size ? square : FrameShape{1, taxels};
}

}  // namespace

std::optional<ProtocolOptions> learn_wiresens(std::span<const std::uint8_t> bytes, const ProtocolOptions& known,
                                              bool any_size) {
  ProtocolOptions learnt = known;
  learnt.name = "wiresens";
  for (std::size_t nodes = 1; nodes <= kMostNodes; ++nodes) {
    for (const bool delimited : {true, false}) {
      const std::optional<std::size_t> taxels = find_taxels(bytes, {kLargestFrame, nodes, delimited});
      if (!taxels) continue;
      learnt.shape = shape_of(*taxels, known, any_size);
      learnt.nodes_per_packet = nodes;
      learnt.delimited = delimited;
      if (learnt.shape) return learnt;
    }
  }
  return std::nullopt;
}

}  // namespace dermis::bytes::devices
