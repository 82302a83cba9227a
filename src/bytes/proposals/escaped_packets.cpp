// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "bytes/proposals/escaped_packets.hpp"

#include <algorithm>
#include <map>
#include <optional>

#include "bytes/proposals/substitutions.hpp"
#include "dermis/bytes/layouts/escapes.hpp"
#include "dermis/bytes/layouts/layout.hpp"

namespace dermis::bytes::proposals {
namespace {

constexpr std::size_t kFewest = 3;
constexpr std::size_t kSmallest = 5;
constexpr std::size_t kMostKept = 2000;
constexpr std::size_t kMostFound = 4;

using layouts::PacketLayout;

struct Escape {
  std::string name{};
  PacketLayout layout{};
};

/// The byte behind an escape of HDLC is one of those that are escaped.
bool may_be_stuffed(std::span<const std::uint8_t> bytes) {
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    if (bytes[i] != 0x7D) continue;
    if (++i == bytes.size() || (bytes[i] != 0x5E && bytes[i] != 0x5D && bytes[i] != 0x31 && bytes[i] != 0x33))
      return false;
  }
  return true;
}

std::optional<Bytes> plain_of(const PacketLayout& layout, std::span<const std::uint8_t> bytes) {
  if (layout.escape == PacketLayout::Escape::stuffed && !may_be_stuffed(bytes)) return std::nullopt;
  Bytes plain;
  if (!layouts::undo_escapes(layout, bytes, plain)) return std::nullopt;
  return plain;
}

/// Nearly all that stands between two delimiters is a packet, and as large as the others.
std::optional<Packets> packets_with(const Escape& escape, std::span<const std::uint8_t> bytes) {
  const std::uint8_t delimiter = layouts::delimiter_of(escape.layout);
  std::map<std::size_t, std::vector<Bytes>> by_size;
  std::size_t pieces = 0;
  std::size_t shortened = 0;
  for (auto from = std::find(bytes.begin(), bytes.end(), delimiter); from != bytes.end();) {
    const auto to = std::find(from + 1, bytes.end(), delimiter);
    if (to == bytes.end()) break;
    const std::span<const std::uint8_t> piece(from + 1, to);
    from = to;
    if (piece.empty()) continue;
    ++pieces;
    std::optional<Bytes> plain = plain_of(escape.layout, piece);
    if (!plain) continue;
    shortened += plain->size() < piece.size() ? 1 : 0;
    std::vector<Bytes>& alike = by_size[plain->size()];
    if (plain->size() >= kSmallest && alike.size() < kMostKept) alike.push_back(*std::move(plain));
  }
  const auto most = std::max_element(by_size.begin(), by_size.end(),
                                     [](const auto& a, const auto& b) { return a.second.size() < b.second.size(); });
  if (most == by_size.end() || most->second.size() < kFewest || 10 * most->second.size() < 8 * pieces || shortened == 0)
    return std::nullopt;
  Packets packets{.size = most->first, .packets = std::move(most->second), .escape = escape.name};
  while (packets.mark_size < packets.size && packets.mark_size < 4 && is_constant(packets, packets.mark_size) &&
         packets.packets.front()[packets.mark_size] != 0)
    ++packets.mark_size;
  return packets;
}

}  // namespace

std::vector<Packets> escaped_packets_in(std::span<const std::uint8_t> bytes) {
  std::vector<Packets> found;
  for (const Escape& escape : {Escape{"cobs", {.packets = {}, .escape = PacketLayout::Escape::cobs}},
                               Escape{"slip", {.packets = {}, .escape = PacketLayout::Escape::slip}},
                               Escape{"7E 7D 20", {{}, PacketLayout::Escape::stuffed, 0x7E, 0x7D, 0x20}}}) {
    if (std::optional<Packets> packets = packets_with(escape, bytes)) found.push_back(*std::move(packets));
  }
  for (const std::string& escape : substitutions_in(bytes)) {
    const Result<layouts::Layout> layout = layouts::layout_from_toml(
        "[layout]\nrows = 1\ncols = 1\npacket = [\"values u8\"]\nescape = \"" + escape + "\"\n", "");
    if (!layout) continue;
    const Escape substituted{escape, std::get<PacketLayout>(layout->form)};
    if (std::optional<Packets> packets = packets_with(substituted, bytes)) found.push_back(*std::move(packets));
    if (found.size() == kMostFound) break;
  }
  return found;
}

}  // namespace dermis::bytes::proposals
