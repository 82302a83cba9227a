// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include "describing/escaped_packets.hpp"

#include <algorithm>
#include <map>
#include <optional>

namespace dermis::describing {
namespace {

constexpr std::size_t kFewest = 3;
constexpr std::size_t kSmallest = 5;
constexpr std::size_t kMostKept = 2000;

struct Escape {
  const char* name;
  std::uint8_t delimiter;
};

std::optional<Bytes> without_cobs(std::span<const std::uint8_t> bytes) {
  Bytes plain;
  while (!bytes.empty()) {
    const std::size_t code = bytes.front();
    if (code > bytes.size()) return std::nullopt;
    plain.insert(plain.end(), bytes.begin() + 1, bytes.begin() + static_cast<std::ptrdiff_t>(code));
    bytes = bytes.subspan(code);
    if (code < 0xFF && !bytes.empty()) plain.push_back(0);
  }
  return plain;
}

std::optional<Bytes> without_slip(std::span<const std::uint8_t> bytes) {
  Bytes plain;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const bool is_escape = bytes[i] == 0xDB;
    if (is_escape && (++i == bytes.size() || (bytes[i] != 0xDC && bytes[i] != 0xDD))) return std::nullopt;
    plain.push_back(!is_escape ? bytes[i] : bytes[i] == 0xDC ? 0xC0 : 0xDB);
  }
  return plain;
}

std::optional<Bytes> without_stuffing(std::span<const std::uint8_t> bytes) {
  Bytes plain;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const bool is_escape = bytes[i] == 0x7D;
    if (is_escape &&
        (++i == bytes.size() || (bytes[i] != 0x5E && bytes[i] != 0x5D && bytes[i] != 0x31 && bytes[i] != 0x33)))
      return std::nullopt;
    plain.push_back(is_escape ? bytes[i] ^ 0x20U : bytes[i]);
  }
  return plain;
}

std::optional<Bytes> plain_of(const Escape& escape, std::span<const std::uint8_t> bytes) {
  if (escape.delimiter == 0) return without_cobs(bytes);
  return escape.delimiter == 0xC0 ? without_slip(bytes) : without_stuffing(bytes);
}

/// Nearly all that stands between two delimiters is a packet, and as large as the others.
std::optional<Packets> packets_with(const Escape& escape, std::span<const std::uint8_t> bytes) {
  std::map<std::size_t, std::vector<Bytes>> by_size;
  std::size_t pieces = 0;
  std::size_t shortened = 0;
  for (auto from = std::find(bytes.begin(), bytes.end(), escape.delimiter); from != bytes.end();) {
    const auto to = std::find(from + 1, bytes.end(), escape.delimiter);
    if (to == bytes.end()) break;
    const std::span<const std::uint8_t> piece(from + 1, to);
    from = to;
    if (piece.empty()) continue;
    ++pieces;
    std::optional<Bytes> plain = plain_of(escape, piece);
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
  for (const Escape& escape : {Escape{"cobs", 0}, {"slip", 0xC0}, {"7E 7D 20", 0x7E}}) {
    if (std::optional<Packets> packets = packets_with(escape, bytes)) found.push_back(*std::move(packets));
  }
  return found;
}

}  // namespace dermis::describing
