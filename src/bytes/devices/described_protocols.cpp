// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <algorithm>
#include <iterator>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "bytes/devices/layout_encoder.hpp"
#include "bytes/devices/protocols.hpp"
#include "dermis/bytes/layouts/layout.hpp"
#include "dermis/bytes/layouts/shipped_layouts.hpp"

namespace dermis::bytes::devices {
namespace {

using layouts::Layout;
using layouts::PacketField;
using layouts::Role;
using layouts::ShippedLayout;

const ShippedLayout& shipped(std::string_view name) {
  return *std::ranges::find(layouts::shipped_layouts(), name, &ShippedLayout::name);
}

Result<std::unique_ptr<Decoder>> make_described_decoder(const ProtocolOptions& options) {
  const ShippedLayout& layout = shipped(options.name);
  if (options.shape) return layouts::make_decoder({layout.of(*options.shape)});
  std::vector<std::shared_ptr<const Layout>> of_sizes;
  for (const FrameShape& shape : layout.sizes) of_sizes.push_back(layout.of(shape));
  return layouts::make_decoder(of_sizes);
}

Result<std::unique_ptr<Encoder>> make_described_encoder(const ProtocolOptions& options) {
  return std::unique_ptr<Encoder>(std::make_unique<LayoutEncoder>(shipped(options.name).of(*options.shape)));
}

/// Its checksum, or else the size of its mark, tells how much is known of a packet.
int strictness_of(const Layout& layout) {
  const layouts::PacketLayout::Packet& packet = std::get<layouts::PacketLayout>(layout.form).packets.front();
  const auto is_checksum = [](const PacketField& field) { return field.role == Role::checksum; };
  if (std::ranges::any_of(packet, is_checksum)) return kHasChecksum;
  const PacketField& mark = packet.front().role == Role::literal ? packet.front() : packet.back();
  return static_cast<int>(mark.literal.size());
}

ProtocolEntry entry_of(const ShippedLayout& layout) {
  return {.name = layout.name,
          .only_shape = layout.sizes.size() == 1 ? std::optional(layout.sizes.front()) : std::nullopt,
          .make_decoder = make_described_decoder,
          .make_encoder = make_described_encoder,
          .strictness = strictness_of(*layout.of(layout.sizes.front())),
          .baud = static_cast<unsigned>(layout.baud)};
}

}  // namespace

const std::vector<ProtocolEntry>& described_protocols() {
  static const std::vector<ProtocolEntry> kEntries = [] {
    std::vector<ProtocolEntry> entries;
    std::ranges::transform(layouts::shipped_layouts(), std::back_inserter(entries), entry_of);
    return entries;
  }();
  return kEntries;
}

}  // namespace dermis::bytes::devices
